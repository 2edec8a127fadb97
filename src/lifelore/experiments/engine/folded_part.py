"""The folded part of a claim's section: causes, choices, all conditions of both readings, settings and origin."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.condition_table import (
    MET,
    bounds_in_words,
    condition_table,
    first_rows,
    measured_in_words,
)  # fmt: skip
from lifelore.experiments.engine.predicate import FAILS, number_in_words, short

SAME = " Real scenes are the same under every seed: where they count, pooled intervals are too narrow."


def folded_part(claim: Claim, result: Mapping, causes: Sequence[str]) -> list[str]:
    """Its lines; `causes` are those that found no room in the visible part."""
    return [
        "<details><summary>All conditions, choices and settings</summary>",
        "",
        *causes,
        *([claim.more, ""] if claim.more else []),
        *_second_reading(claim, result),
        *_seeds(claim, result),
        *_first_reading(claim, result),
        f"**Settings.** Mode {result['mode']}, seed {result['seed']}, {short(result['seconds'])} s of computing. "
        f"{_settings_in_words(result['settings'])}.",
        *_made_in_words(result.get("made")),
        "",
        "</details>",
        "",
    ]


def _second_reading(claim: Claim, result: Mapping) -> list[str]:
    if claim.second is None or not result.get("second"):
        return []
    measured = result["measured"]
    rows = [
        f"| {one.role} | {one.condition.words} | {bounds_in_words(one.condition, measured)} "
        f"| {measured_in_words(one.condition, measured)} | {MET[one.answer(measured)]} |"
        for one in claim.second.conditions
    ]
    return [
        f"**Second reading: {result['second']['verdict']}.** {claim.second.why}", "",
        "| counts as | condition | asked | measured [95\u00a0%] | met |", "|---|---|---|---|---|", *rows, "",
    ]  # fmt: skip


def _seeds(claim: Claim, result: Mapping) -> list[str]:
    """The numbers of each seed, where several were pooled."""
    pool = result.get("seeds")
    if not pool or claim.second is None:
        return []
    asked_by = {one.condition.measure: one.condition.name for one in claim.second.conditions}
    heads = [f"seed {one['seed']}: {one['verdict']}" for one in pool["by_seed"]]
    rows = [
        f"| {asked_by[name]} | {number_in_words(number)} | "
        + " | ".join(number_in_words(one["measured"][name]) for one in pool["by_seed"])
        + " |"
        for name, number in pool["pooled"].items()
    ]
    same = SAME if claim.data else ""
    return [
        f"**{len(heads)} seeds: {pool['verdict']}.** The table above is of the first seed.{same}", "",
        f"| condition | pooled | {' | '.join(heads)} |", "|---|---|" + "---|" * len(heads), *rows, "",
    ]  # fmt: skip


def _first_reading(claim: Claim, result: Mapping) -> list[str]:
    measured = result["measured"]
    conditions = claim.predicate.conditions
    rows = first_rows(claim, measured)
    rules = [f"*{rule.verdict}*: {_rule_in_words(rule.all_of, rule.any_of, len(conditions))}"
             for rule in claim.predicate.rules]  # fmt: skip
    return [
        f"**First reading: {result['verdict']}.** {'; '.join(rules)}; else *{FAILS}*.",
        "",
        *condition_table(rows, {row: row.condition.words for row in rows}, measured, n=True),
    ]


def _rule_in_words(all_of: Sequence[str], any_of: Sequence[str], n_conditions: int) -> str:
    if len(all_of) == n_conditions:
        return "all conditions"
    parts = [f"all of {', '.join(all_of)}"] if all_of else []
    parts += [f"one of {', '.join(any_of)}"] if any_of else []
    return " and ".join(parts)


def _made_in_words(made: Mapping[str, Any] | None) -> list[str]:
    """When and on what a result was made; nothing for an earlier result, which does not say."""
    if made is None:
        return []
    commit = "outside a checkout" if made["commit"] is None else f"at commit {made['commit'][:10]}"
    changed = " with changes" if made["changed"] else ""
    data = "".join(f", data `{name}` {key}" for name, key in made["data"].items())
    return ["", f"Made {made['date']} {commit}{changed}, {made['cores']} cores of {made['processor']}{data}."]


def _settings_in_words(settings: Mapping) -> str:
    return ", ".join(f"`{key}` {json.dumps(value, ensure_ascii=False)}" for key, value in settings.items())
