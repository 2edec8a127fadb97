"""The folded part of a claim's section: causes, choices, all conditions of both readings, settings and origin."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

from reproduction.engine.claim import Claim
from reproduction.engine.condition_table import condition_table, first_rows, second_rows, table_line
from reproduction.engine.predicate import FAILS, Rule, number_in_words, short

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
    rows = second_rows(claim, result["measured"])
    return [
        f"**Second reading: {result['second']['verdict']}.** {claim.second.why}", "",
        *([f"**Filed again.** {claim.refiled}", ""] if claim.refiled else []),
        *condition_table(rows, {row: claim.words_of(row.condition) for row in rows}, result["measured"], n=True),
    ]  # fmt: skip


def _seeds(claim: Claim, result: Mapping) -> list[str]:
    """The numbers of each seed, where several were pooled."""
    pool = result.get("seeds")
    if not pool or claim.second is None:
        return []
    place_of = {one.condition.measure: n for n, one in enumerate(claim.second.conditions, 1)}
    heads = ["", "pooled", *(f"seed {one['seed']}: {one['verdict']}" for one in pool["by_seed"])]
    rows = [
        [str(place_of[name]), number_in_words(number)]
        + [number_in_words(one["measured"][name]) for one in pool["by_seed"]]
        for name, number in sorted(pool["pooled"].items(), key=lambda item: place_of[item[0]])
    ]
    same = SAME if claim.data else ""
    return [
        f"**{len(pool['seeds'])} seeds: {pool['verdict']}.** The table above is of the first seed.{same}", "",
        table_line(heads), "|" + "---|" * len(heads), *map(table_line, rows), "",
    ]  # fmt: skip


def _first_reading(claim: Claim, result: Mapping) -> list[str]:
    measured = result["measured"]
    rows = first_rows(claim, measured)
    place_of = {row.condition.name: row.number for row in rows}
    rules = [f"*{rule.verdict}*: {_rule_in_words(rule, place_of)}" for rule in claim.predicate.rules]
    words = {row: claim.words_of(row.condition) for row in rows}
    return [
        f"**First reading: {result['verdict']}.** {'; '.join(rules)}; else *{FAILS}*.",
        "",
        *condition_table(rows, words, measured, n=True, roles=False),
    ]


def _rule_in_words(rule: Rule, place_of: Mapping[str, int]) -> str:
    """The conditions of a rule by their numbers."""
    if len(rule.all_of) == len(place_of):
        return "all conditions"
    kinds = {"all of": rule.all_of, "one of": rule.any_of}
    places = {how: ", ".join(str(place_of[name]) for name in names) for how, names in kinds.items() if names}
    return " and ".join(f"{how} {numbers}" for how, numbers in places.items())


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
