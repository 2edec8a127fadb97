"""The first page of the reproduction: what of the thesis holds, in plain sentences, and which claims are open."""

from collections.abc import Mapping, Sequence

from lifelore.experiments.engine.claim_section import anchor, verdict_now
from lifelore.experiments.engine.condition_table import counted_rows
from lifelore.experiments.engine.ledger import entries
from lifelore.experiments.engine.more_seeds import deciding_conditions
from lifelore.experiments.engine.predicate import FAILS, HOLDS, IN_PART, UNTESTED, VERDICTS
from lifelore.experiments.engine.registry import built_ids, claim_of
from lifelore.experiments.engine.run_again import run_again
from lifelore.experiments.engine.second_reading import NO, SECOND_VERDICTS, UNDECIDED

CHAPTERS = {
    "2": "Chapter 2: perception",
    "3": "Chapter 3: action",
    "4": "Chapter 4: interaction",
    "5": "Chapter 5: the abstractions together",
}
ORDER = (HOLDS, IN_PART, UNDECIDED, FAILS, UNTESTED)
NOTES = {"5": "These are ideas: the thesis proposes them without numbers."}
"""Words under the title of a chapter."""
PLURALS = {HOLDS: "hold", IN_PART: "hold in part", FAILS: "do not hold", UNDECIDED: "are undecided"}
MOST_MISSED = 3
"""Names of unmet conditions after a claim's sentence."""
OPENING = """# Reproduction

What the thesis says, and whether our measurements agree: every claim in a sentence under its verdict. The chapter
pages show the numbers. These pages are generated from `results/` by `make docs`; do not edit them by hand.
"""
READINGS = """## What a verdict means

The conditions of each verdict were filed before the first full run and stand in the `claim.toml` of the claim's
folder. Intervals are 95 %; ratios and differences are paired.

The first reading of a claim has rules of its own, which stand in the folded part of its section. A *second
reading* has one meaning of each verdict for all claims. It was filed, as data, before the run that it judges, and
after the first reading's result was known.

- **holds**: what the thesis's sentence says holds by its 95 % intervals, with the numbers it prints, at the
  default and in most of the choices that the thesis leaves open.
- **holds in part**: it holds at the default or in a stated minority of these choices, or a printed number is
  missed.
- **undecided**: an interval spans its bound.
- **does not hold**: otherwise. Our own extras are shown apart and never count.

Where a verdict would turn if one number moved by its interval's width, or a share of the choices by one choice,
three more seeds are run at full size and pooled (`lifelore reproduce --full --seeds 4 C3.17`): the mean of their
values, with the interval of a mean of independent numbers. The pool decides, and the claim's section says where
single seeds disagree.
"""


def chapter_of(claim_id: str) -> str:
    """The number of its chapter: ``2`` of ``C2.13``."""
    return claim_id[1:].partition(".")[0]


def index_page(found: Sequence[Mapping], verified: Sequence[Mapping], figures: str) -> str:
    """The page as Markdown; `verified` as in `run_again`, `figures`: the folder of the results as links see it."""
    lines = [OPENING, _total(found), "", f"![Verdicts of all claims]({figures}/verdicts.png)", ""]
    lines += ["A tile is a claim: its upper half the second reading, the rest the first.", ""]
    lines += ["## What holds", ""]
    lines += ["The verdict is that of the second reading; *¹* marks claims that have a first reading only.", ""]
    for number, title in CHAPTERS.items():
        results = [result for result in found if chapter_of(result["claim"]) == number]
        if results:
            lines += [f"### [{title}](chapter{number}.md)", ""]
            lines += [NOTES[number], ""] if number in NOTES else []
            lines += _sentences(results)
    lines += [*_without_answer(found), READINGS, *run_again(found, verified, figures)]
    lines += [*_tables(found), *_counts(found)]
    return "\n".join(lines)


def _link(claim_id: str) -> str:
    return f"[{claim_id}](chapter{chapter_of(claim_id)}.md#{anchor(claim_id)})"


def _sentences(results: Sequence[Mapping]) -> list[str]:
    lines = []
    for verdict in ORDER:
        here = [result for result in results if verdict_now(result) == verdict]
        if here:
            lines += [f"**{verdict.capitalize()}**", ""]
            lines += [_sentence(result) for result in here]
            lines.append("")
    return lines


def _sentence(result: Mapping) -> str:
    """A line of the list: the claim's sentence, and which of its conditions are not met."""
    claim = claim_of(result["claim"])
    missed = [f"*{row.condition.name}*" for row in counted_rows(claim, result) if row.answer == NO]
    more = f"; and {len(missed) - MOST_MISSED} more" if len(missed) > MOST_MISSED else ""
    why = f" Not met: {'; '.join(missed[:MOST_MISSED])}{more}." if missed else ""
    return f"- {_link(claim.id)}{'' if result.get('second') else '¹'} {claim.sentence}{why}"


def _total(found: Sequence[Mapping]) -> str:
    """How many claims have each verdict."""
    now = [verdict_now(result) for result in found]
    counts = [f"{now.count(verdict)} {PLURALS.get(verdict, verdict)}" for verdict in ORDER if verdict in now]
    return f"**Of {len(found)} claims with a result, {', '.join(counts)}.**"


def _without_answer(found: Sequence[Mapping]) -> list[str]:
    """The claims without a result or a verdict, and those without a second reading, and why."""
    have = {result["claim"] for result in found}
    absent = [f"- {entry.id}: {_why_absent(entry.id)}." for entry in entries() if entry.id not in have]
    absent += [f"- {_link(r['claim'])}: {claim_of(r['claim']).ran}" for r in found if verdict_now(r) == UNTESTED]
    lines = ["## Claims without an answer, and why", "", *(absent or ["Every claim has an answer."]), ""]
    once = [r["claim"] for r in found if not r.get("second")]
    near = [r["claim"] for r in found if r.get("second") and not r.get("seeds") and _is_close(r)]
    filed = [claim_id for claim_id in once if claim_of(claim_id).second is not None]
    for ids, why in (
        (filed, "The second reading of these claims is filed; its full run has not been made yet"),
        (
            [claim_id for claim_id in once if claim_id not in filed],
            "No second reading of these claims is filed yet",
        ),
        (
            near,
            "These verdicts would turn if one number moved by its interval's width, or a share of the choices by"
            " one choice; three more seeds have not run yet",
        ),
    ):
        if ids:
            lines += [f"{why}: {', '.join(map(_link, ids))}.", ""]
    return lines


def _is_close(result: Mapping) -> bool:
    return bool(deciding_conditions(claim_of(result["claim"]), result["measured"]))


def _why_absent(claim_id: str) -> str:
    return "built, its full run has not been made yet" if claim_id in built_ids() else "not built yet"


def _tables(found: Sequence[Mapping]) -> list[str]:
    """Both verdicts of every claim, a table a chapter, folded."""
    where = {entry.id: entry.where for entry in entries()}
    lines = ["## Both readings", "", "<details><summary>All claims with both verdicts</summary>", ""]
    for number, title in CHAPTERS.items():
        results = [result for result in found if chapter_of(result["claim"]) == number]
        if not results:
            continue
        lines += [
            f"**{title}**",
            "",
            "| claim | thesis | what | first reading | second reading |",
            "|---|---|---|---|---|",
        ]
        for result in results:
            claim_id = result["claim"]
            verdict = result["verdict"] if result["mode"] == "full" else f"{result['verdict']} (quick run)"
            again = f"**{verdict_now(result)}**" if result.get("second") else "–"
            again += f" ({len(result['seeds']['seeds'])} seeds)" if result.get("seeds") else ""
            title = claim_of(claim_id).title
            lines.append(f"| {_link(claim_id)} | {where[claim_id]} | {title} | **{verdict}** | {again} |")
        lines.append("")
    return [*lines, "</details>", ""]


def _counts(found: Sequence[Mapping]) -> list[str]:
    counts = [f"{sum(r['verdict'] == v for r in found)} {v}" for v in VERDICTS]
    seconds = [verdict_now(result) for result in found if result.get("second")]
    again = [f"{seconds.count(v)} {v}" for v in SECOND_VERDICTS if v in seconds]
    left = len(entries()) - len(found)
    lines = []
    if seconds:
        lines += [f"Second reading: {', '.join(again)}; {len(found) - len(seconds)} claims have none yet.", ""]
    return [
        *lines, f"First reading: {', '.join(counts)}; {left} of {len(entries())} claims have no result yet.", "",
    ]  # fmt: skip
