"""The section of one claim on its chapter's page, in at most `MOST_WORDS` visible words; all else is folded.

Visible are the verdict and why, the thesis's sentence, what was done, the figure, and those conditions that the
verdict counts. A condition is shown by its name, or in its own words as far as they fit: first those not met, then
headline, printed, grid. The folded part has all of them in words, likely causes, choices and settings.
"""

import re
from collections.abc import Mapping, Sequence

from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.condition_table import (
    COUNTED,
    Row,
    condition_table,
    counted_rows,
    measured_now,
)
from lifelore.experiments.engine.folded_part import folded_part
from lifelore.experiments.engine.registry import claim_of
from lifelore.experiments.engine.second_reading import MISSING, NO, OPEN, YES

MOST_WORDS = 250
"""Visible words of a claim, its heading and table included, its figure not."""
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
    causes = _causes(claim, [row.condition.name for row in rows if row.answer in (NO, OPEN)])

    def visible(words: Mapping[Row, str], causes: Sequence[str] = ()) -> str:
        return "\n".join(
            [
                *_opening(claim, result),
                *condition_table(rows, words, measured_now(result)),
                f"![{claim.title}]({figures}/{claim.id}/figure.png)",
                "",
                _why(result, rows),
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
    in_full = [(row, row.condition.words) for row in by_weight]
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


def _why(result: Mapping, rows: Sequence[Row]) -> str:
    """Why the verdict is what it is: how many conditions are met, and the names of those that are not."""
    met = sum(row.answer == YES for row in rows)
    words = [f"{met} of {len(rows)} conditions are met"]
    for answer, kind in (
        (NO, "Not met"),
        (OPEN, "Open, as the interval spans the bound"),
        (MISSING, "Not measured"),
    ):
        names = [f"*{row.condition.name}*" for row in rows if row.answer == answer]
        if names:
            words.append(f"{kind}: {'; '.join(names[:4])}" + (f"; and {len(names) - 4} more" if names[4:] else ""))
    return f"**{verdict_now(result).capitalize()}, because** {'. '.join(words)}.{_on_seeds(result)}"


def _on_seeds(result: Mapping) -> str:
    """Whether a single seed would have had another verdict."""
    own = [one["verdict"] for one in (result.get("seeds") or {}).get("by_seed", ())]
    return f" The verdict depends on the seed: {', '.join(own)}." if len(set(own)) > 1 else ""


def _causes(claim: Claim, names: Sequence[str]) -> list[str]:
    """Why conditions are likely not met, a line each, and whether a test shows it."""
    named = [name for name in names if name in claim.causes]
    lines = [f"- {name}: {claim.causes[name]} ({_shown(claim.shown_by.get(name))})." for name in named]
    return ["**Why not, likely.**", "", *lines, ""] if lines else []


def _shown(erratum: str | None) -> str:
    return f"shown by tests: [{erratum}](../errata.md)" if erratum else "untested"
