"""The first page of the reproduction: what of the thesis holds, in plain sentences, and which claims are open."""

from collections.abc import Mapping, Sequence

from reproduction.engine.claim_section import anchor, verdict_now
from reproduction.engine.ledger import entries
from reproduction.engine.more_seeds import deciding_conditions
from reproduction.engine.predicate import FAILS, HOLDS, IN_PART, UNTESTED, VERDICTS
from reproduction.engine.reason import reason_in_words
from reproduction.engine.registry import built_ids, claim_of
from reproduction.engine.run_again import run_again
from reproduction.engine.second_reading import MINORITY, SECOND_VERDICTS, UNDECIDED

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
SINGULARS = {UNDECIDED: "is undecided"}
"""A verdict as the verb of a sentence; itself where it is not named."""
OURS, IDEAS = "not of the thesis", "5"
"""Where a claim of our own stands, and the chapter of ideas."""
OPENING = """# Reproduction

What the thesis says, and whether our measurements agree: every claim in a sentence under its verdict. The chapter
pages show the numbers. These pages are generated from `results/` by `make docs`; do not edit them by hand.
"""
READINGS = f"""## What a verdict means

- **holds**: what the thesis's sentence says (the *headline*) is certain, by 95 % intervals, at the default, with
  the numbers that the thesis prints, and in most of the choices that it leaves open (the *grid*), where these were
  varied.
- **holds in part**: the headline is certain at the default, but a printed number is missed or most of the grid
  fails; or it fails at the default and holds in more than a tenth ({MINORITY:g}) of the grid.
- **undecided**: an interval spans its bound; more runs could tell.
- **does not hold**: otherwise. Our own extras are shown apart and never count.

The conditions of each verdict were filed, as data, before the run that it judges; a test compares the commits.
Ratios and differences are paired. Each claim also has a *first reading*, filed before its first full run, with
rules of its own. The verdicts here are those of the *second reading*, which has one meaning of each verdict for
all claims; it was filed after the first result was known. A reading that was filed again after a run says so in
its section. [Both readings](#both-readings) of every claim stand below, and in the folded part of its section.

Where a verdict would turn if one number moved by its interval's width, or a share of the grid by one choice,
three more seeds are run at full size and pooled (`lifelore reproduce --full --seeds 4 C3.17`): the mean of their
values, with the interval of a mean of independent numbers. The pool decides, and the claim's section says where
single seeds disagree.
"""


def chapter_of(claim_id: str) -> str:
    """The number of its chapter: ``2`` of ``C2.13``."""
    return claim_id[1:].partition(".")[0]


def index_page(found: Sequence[Mapping], verified: Sequence[Mapping], figures: str) -> str:
    """The page as Markdown; `verified` as in `run_again`, `figures`: the folder of the results as links see it."""
    lines = [OPENING, *_totals(found), "", f"![Verdicts of all claims]({figures}/verdicts.png)", "", READINGS]
    lines += ["## What holds", "", "*¹* marks claims that have a first reading only.", ""]
    for number, title in CHAPTERS.items():
        results = [result for result in found if chapter_of(result["claim"]) == number]
        if results:
            lines += [f"### [{title}](chapter{number}.md)", ""]
            lines += [NOTES[number], ""] if number in NOTES else []
            lines += _sentences(results)
    lines += [*_without_answer(found), *run_again(found, verified, figures)]
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
    """A line of the list: the claim's sentence, and the reason for its verdict."""
    claim = claim_of(result["claim"])
    reason = reason_in_words(claim, result)
    how = {HOLDS: "But", UNTESTED: "Why"}.get(verdict_now(result), "Measured")
    words = f" {how}: {reason}." if reason else ""
    return f"- {_link(claim.id)}{'' if result.get('second') else '¹'} {claim.sentence}{words}"


def _totals(found: Sequence[Mapping]) -> list[str]:
    """How many claims of the thesis, of its ideas and of our own have each verdict."""
    ours = [r for r in found if claim_of(r["claim"]).where == OURS]
    ideas = [r for r in found if chapter_of(r["claim"]) == IDEAS and r not in ours]
    thesis = [r for r in found if r not in (*ours, *ideas)]
    named = (("Claims of the thesis", thesis), ("Ideas that it proposes", ideas), ("Claims of our own", ours))
    return [f"- {kind}: {_total(results)}." for kind, results in named if results]


def _total(results: Sequence[Mapping]) -> str:
    now = [verdict_now(result) for result in results]
    counts = {verdict: now.count(verdict) for verdict in ORDER if verdict in now}
    words = [f"{n} {(SINGULARS if n == 1 else PLURALS).get(verdict, verdict)}" for verdict, n in counts.items()]
    return f"of {len(now)}, {', '.join(words)}"


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
