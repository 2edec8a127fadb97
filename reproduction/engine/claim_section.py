"""The section of one claim on its chapter's page, in at most `MOST_WORDS` visible words; all else is folded.

Visible are the verdict and why, the thesis's sentence, what was done, the figure, and those conditions that the
verdict counts. A condition has the number of its place in its reading, by which sentences name it. It is shown in
its own words as far as they fit, else by its name: first those not met, then headline, printed, grid. The folded
part has all of them in words, likely causes, choices and settings.
"""

import re
from collections.abc import Mapping, Sequence

from reproduction.engine.claim import Claim
from reproduction.engine.condition_table import (
    COUNTED,
    Row,
    condition_table,
    counted_rows,
    measured_now,
)
from reproduction.engine.folded_part import folded_part
from reproduction.engine.predicate import HOLDS
from reproduction.engine.reason import reason_in_words
from reproduction.engine.registry import claim_of
from reproduction.engine.second_reading import GRID, MISSING, NO, OPEN, YES

MOST_WORDS = 250
"""Visible words of a claim, its heading and table included, its figure not."""
NO_GRID = "Every condition is met; the verdict asks no grid of choices."
PRIVATE = "Real scenes and labels are not public (`LIFELORE_DATA`); `--set real=false` runs the simulated part."


def anchor(claim_id: str) -> str:
    """The anchor of a claim on its page: ``c3-1``."""
    return claim_id.lower().replace(".", "-")


def verdict_now(result: Mapping) -> str:
    """The verdict of the second reading where there is one, over all its seeds, else of the first."""
    return (result.get("seeds") or result.get("second") or result)["verdict"]


def visible_words(section: str) -> int:
    """Words outside folded parts; pictures, anchors and the targets of links do not count."""
    text = re.sub(r"<details>.*?</details>", "", section, flags=re.S)
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)|<[^>]+>|(?<=\])\([^)]*\)", "", text)
    return sum(bool(re.search(r"\w", word)) for word in text.split())


def claim_section(result: Mapping, figures: str) -> str:
    """The section as Markdown; `figures` is the folder of the results as the page's links see it."""
    claim = claim_of(result["claim"])
    rows = counted_rows(claim, result)
    causes = _causes(claim, [row for row in rows if row.answer in (NO, OPEN)])

    def visible(words: Mapping[Row, str], causes: Sequence[str] = ()) -> str:
        return "\n".join(
            [
                *_opening(claim, result),
                *condition_table(rows, words, measured_now(result), roles=bool(result.get("second"))),
                f"![{claim.title}]({figures}/{claim.id}/figure.png)",
                "",
                _why(claim, result, rows),
                "",
                *causes,
            ]
        )

    def fits(words: Mapping[Row, str], causes: Sequence[str]) -> bool:
        return visible_words(visible(words, causes)) <= MOST_WORDS

    by_weight = sorted(rows, key=_weight)
    words: dict[Row, str] = {}
    shown: list[str] = []
    names = [(row, f"*{row.condition.name}*") for row in by_weight]
    in_full = [(row, claim.words_of(row.condition)) for row in by_weight]
    n_missed = sum(row.answer != YES for row in rows)
    for step in (names, in_full[:n_missed], None, in_full[n_missed:]):
        if step is None:
            shown = causes if fits(words, causes) else []
            continue
        for row, tried in step:
            words = {**words, row: tried} if fits({**words, row: tried}, shown) else words
    folded = [] if shown else causes
    return "\n".join([visible(words, shown), *folded_part(claim, result, folded)])


def _weight(row: Row) -> tuple[bool, int]:
    return row.answer == YES, COUNTED.index(row.role)


def _opening(claim: Claim, result: Mapping) -> list[str]:
    first, second = result["verdict"], result.get("second")
    now = verdict_now(result).capitalize()
    reading = f"first reading: {first}" if second else "first reading; there is no second yet"
    if result.get("seeds"):
        reading = f"{len(result['seeds']['seeds'])} seeds pooled; {reading}"
    where = f" {claim.where}." if claim.where else ""
    return [
        f'<a id="{anchor(claim.id)}"></a>',
        "",
        f"## {claim.id} — {claim.title}",
        "",
        f"**{now}** ({reading}).{where}",
        "",
        f"**Thesis.** {result['thesis']}",
        "",
        f"**Done.** {claim.ran}",
        "",
        *([PRIVATE, ""] if claim.data else []),
    ]


def _why(claim: Claim, result: Mapping, rows: Sequence[Row]) -> str:
    """The reason for the verdict, then the conditions that are not met by their numbers in the table."""
    verdict, reason = verdict_now(result), reason_in_words(claim, result)
    if reason:
        opening = f"**{verdict.capitalize()}**{', but' if verdict == HOLDS else ':'} {reason}."
    else:
        opening = f"**{verdict.capitalize()}.**"
    return " ".join([opening, *answers_in_words(rows), *_on_seeds(result)])


def answers_in_words(rows: Sequence[Row]) -> list[str]:
    """Sentences that name the conditions not met, by role, those that are open and those not measured."""
    unmet = {role: [row.number for row in rows if (row.role, row.answer) == (role, NO)] for role in COUNTED}
    kinds = {f"{role.capitalize()} not met": numbers for role, numbers in unmet.items()}
    kinds["Open, as the interval spans the bound"] = [row.number for row in rows if row.answer == OPEN]
    kinds["Not measured"] = [row.number for row in rows if row.answer == MISSING]
    found = [f"{kind}: {', '.join(map(str, numbers))}." for kind, numbers in kinds.items() if numbers]
    if found:
        return found
    return ["Every condition is met." if any(row.role == GRID for row in rows) else NO_GRID]


def _on_seeds(result: Mapping) -> list[str]:
    """Whether a single seed would have had another verdict."""
    own = [one["verdict"] for one in (result.get("seeds") or {}).get("by_seed", ())]
    return [f"The verdict depends on the seed: {', '.join(own)}."] if len(set(own)) > 1 else []


def _causes(claim: Claim, rows: Sequence[Row]) -> list[str]:
    """Why conditions are likely not met, a line each, and whether a test shows it."""
    lines = [
        f"- {row.number}: {claim.causes[row.condition.name]} ({_shown(claim.shown_by.get(row.condition.name))})."
        for row in rows
        if row.condition.name in claim.causes
    ]
    return ["**Likely causes.**", "", *lines, ""] if lines else []


def _shown(erratum: str | None) -> str:
    return f"shown by tests: [{erratum}](../errata.md)" if erratum else "untested"
