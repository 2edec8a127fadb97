"""Pages of reproductions: every result under `results/`, rendered into `docs/reproduction/`, one page a chapter.

Run ``python -m lifelore.experiments.engine.report`` after a full run; a test fails where pages and results differ.
Ids of claims as arguments (``… report C2.5 C3.1``) draw their figures again from the stored results.
"""

import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from lifelore.core.errors import InputError, StoreError
from lifelore.experiments.engine.cell_store import write_atomically
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.ledger import entries
from lifelore.experiments.engine.predicate import VERDICTS, Condition, number_in_words, short
from lifelore.experiments.engine.registry import claim_of
from lifelore.experiments.engine.reproduce import own_rows
from lifelore.experiments.engine.second_reading import SECOND_VERDICTS

INTRODUCTION = """# Reproduction

What the thesis reports, what we measure, and whether it holds. These pages are generated from `results/` by
`make docs`; do not edit them by hand. The conditions of each verdict were filed before the first full run and
stand in the `claim.toml` of the claim's folder. Intervals are 95 %; ratios and differences are paired.

The first reading of a claim has rules of its own. A *second reading* has one meaning of each verdict for all
claims. It was filed, as data, before the run that it judges, and after the first reading's result was known.

- **holds**: what the thesis's sentence says holds by its 95 % intervals, with the numbers it prints, at the
  default and in most of the choices that the thesis leaves open.
- **holds in part**: it holds at the default or in a stated minority of these choices, or a printed number is
  missed.
- **undecided**: an interval spans its bound.
- **does not hold**: otherwise. Our own extras are shown apart and never count.
"""
CHAPTERS = {
    "2": "Chapter 2: perception",
    "3": "Chapter 3: action",
    "4": "Chapter 4: interaction",
    "5": "Chapter 5: the abstractions together",
}
OPS = {">": "above", ">=": "at least", "<": "below", "<=": "at most", "between": "between"}
ANSWERS = {True: "yes", False: "**no**", None: "not measured"}


def render_pages(results: str | Path = "results", figures: str = "../../results") -> dict[str, str]:
    """The pages as Markdown, by file name.

    Parameters
    ----------
    results : path
        Folder of ``<ID>/result.json``.
    figures : str
        The same folder as the pages' links see it.
    """
    found = read_results(results)
    pages = {"index.md": _index(found, figures)}
    for number, title in CHAPTERS.items():
        sections = [_section(result, figures) for result in found if _chapter(result["claim"]) == number]
        if sections:
            pages[f"chapter{number}.md"] = "\n".join([f"# {title}", "", *sections])
    return pages


def write_pages(results: str | Path = "results", folder: str | Path = "docs/reproduction") -> Path:
    """Render the pages and write them; returns their folder."""
    folder = Path(folder)
    for name, text in render_pages(results).items():
        write_atomically(folder / name, text)
    return folder


def read_results(results: str | Path) -> list[dict]:
    """All results of a folder, in the ledger's order.

    Raises
    ------
    StoreError, InputError
        A result cannot be read, or is not JSON.
    """
    found = []
    for entry in entries():
        path = Path(results) / entry.id / "result.json"
        if path.exists():
            try:
                found.append(json.loads(path.read_text(encoding="utf-8")))
            except OSError as error:
                raise StoreError(f"cannot read {path}: {error.strerror}") from None
            except ValueError:
                raise InputError(f"{path} is not JSON; run `lifelore reproduce {entry.id} --full` again") from None
    return found


def _chapter(claim_id: str) -> str:
    return claim_id[1:].partition(".")[0]


def _index(found: list[dict], figures: str) -> str:
    where = {entry.id: entry.where for entry in entries()}
    lines = [INTRODUCTION, f"![Verdicts of all claims]({figures}/verdicts.png)", ""]
    lines += ["A tile is a claim: its upper half the second reading, the rest the first.", ""]
    for number, title in CHAPTERS.items():
        results = [result for result in found if _chapter(result["claim"]) == number]
        if not results:
            continue
        lines += [
            f"## [{title}](chapter{number}.md)",
            "",
            "| claim | thesis | what | first reading | second reading |",
            "|---|---|---|---|---|",
        ]
        for result in results:
            claim_id = result["claim"]
            link = f"[{claim_id}](chapter{number}.md#{_anchor(claim_id)})"
            verdict = result["verdict"] if result["mode"] == "full" else f"{result['verdict']} (quick run)"
            second = result.get("second")
            again = f"**{second['verdict']}**" if second else "–"
            title = claim_of(claim_id).title
            lines.append(f"| {link} | {where[claim_id]} | {title} | **{verdict}** | {again} |")
        lines.append("")
    counts = [f"{sum(r['verdict'] == v for r in found)} {v}" for v in VERDICTS]
    seconds = [result["second"]["verdict"] for result in found if result.get("second")]
    again = [f"{seconds.count(v)} {v}" for v in SECOND_VERDICTS if v in seconds]
    left = len(entries()) - len(found)
    if seconds:
        lines += [f"Second reading: {', '.join(again)}; {len(found) - len(seconds)} claims have none yet.", ""]
    lines += [f"First reading: {', '.join(counts)}; {left} of {len(entries())} claims have no result yet.", ""]
    return "\n".join(lines)


def _anchor(claim_id: str) -> str:
    return claim_id.lower().replace(".", "-")


def _section(result: Mapping, figures: str) -> str:
    claim = claim_of(result["claim"])
    lines = [
        f'<a id="{_anchor(claim.id)}"></a>',
        "",
        f"## {claim.id} — {claim.title}",
        "",
        _verdicts(result, claim),
        "",
        f"**Thesis.** {result['thesis']}",
        "",
        f"**Run.** {claim.ran}",
        "",
        "| condition | asked | measured [95 %] | met |",
        "|---|---|---|---|",
        *(_condition_row(c, result["measured"]) for c in claim.predicate.conditions),
        "",
        f"![{claim.title}]({figures}/{claim.id}/figure.png)",
        "",
        *_causes(claim, result["measured"]),
        *_second_reading(claim, result),
        "<details><summary>Settings</summary>",
        "",
        f"Mode {result['mode']}, seed {result['seed']}, {short(result['seconds'])} s of computing. "
        f"{_settings_in_words(result['settings'])}.",
        *_made_in_words(result.get("made")),
        "",
        "</details>",
        "",
    ]
    return "\n".join(lines)


def _verdicts(result: Mapping, claim: Claim) -> str:
    first = result["verdict"].capitalize()
    if not result.get("second"):
        return f"**{first}.** {claim.where}"
    return (
        f"**{result['second']['verdict'].capitalize()}**; in the first reading: {result['verdict']}. {claim.where}"
    )


def _second_reading(claim: Claim, result: Mapping) -> list[str]:
    """The conditions of the second reading, and how it differs from the first."""
    if claim.second is None or not result.get("second"):
        return []
    rows = [
        f"| {one.role} | {one.condition.words} | {_bounds_in_words(one.condition)} | "
        f"{one.answer(result['measured'])} |"
        for one in claim.second.conditions
    ]
    return [
        f"**Second reading.** {claim.second.why}", "",
        "| counts as | condition | asked | met |", "|---|---|---|---|", *rows, "",
    ]  # fmt: skip


def _condition_row(condition: Condition, measured: Mapping) -> str:
    number = measured.get(condition.measure)
    value = number_in_words(number) if number else "–"
    return f"| {condition.words} | {_asked(condition)} | {value} | {ANSWERS[condition.met(measured)]} |"


def _asked(condition: Condition) -> str:
    words = _bounds_in_words(condition)
    return f"interval {words}" if condition.part == "interval" else words


def _bounds_in_words(condition: Condition) -> str:
    bounds = condition.bound if isinstance(condition.bound, tuple) else (condition.bound,)
    return f"{OPS[condition.op]} {' and '.join(short(bound) for bound in bounds)}"


def _causes(claim: Claim, measured: Mapping) -> list[str]:
    """Why conditions are likely not met, a line each, and whether a test shows it."""
    failed = [c for c in claim.predicate.conditions if c.met(measured) is False and c.name in claim.causes]
    if not failed:
        return []
    lines = [f"- {c.name}: {claim.causes[c.name]} ({_shown(claim.shown_by.get(c.name))})." for c in failed]
    return ["**Why not, likely.**", "", *lines, ""]


def _shown(erratum: str | None) -> str:
    return f"shown by tests: [{erratum}](../errata.md)" if erratum else "untested"


def _made_in_words(made: Mapping | None) -> list[str]:
    """When and on what a result was made; nothing for an earlier result, which does not say."""
    if made is None:
        return []
    commit = "outside a checkout" if made["commit"] is None else f"at commit {made['commit'][:10]}"
    changed = " with changes" if made["changed"] else ""
    data = "".join(f", data `{name}` {key}" for name, key in made["data"].items())
    return ["", f"Made {made['date']} {commit}{changed}, {made['cores']} cores of {made['processor']}{data}."]


def _settings_in_words(settings: Mapping) -> str:
    return ", ".join(f"`{key}` {json.dumps(value, ensure_ascii=False)}" for key, value in settings.items())


def verdicts(results: str | Path) -> dict[str, list[tuple[str, str | None, str | None]]]:
    """By chapter: id, verdict of the first and of the second reading of every claim of the ledger."""
    found = {result["claim"]: result for result in read_results(results)}
    rooms: dict[str, list[tuple[str, str | None, str | None]]] = {title: [] for title in CHAPTERS.values()}
    for entry in entries():
        result = found.get(entry.id, {})
        second = (result.get("second") or {}).get("verdict")
        rooms[CHAPTERS[_chapter(entry.id)]].append((entry.id, result.get("verdict"), second))
    return rooms


def draw_summary(results: str | Path) -> None:
    """Draw all verdicts as ``verdicts.png`` among the results."""
    from lifelore.figures.style import save_figure
    from lifelore.figures.verdict_tiles import draw_verdicts

    save_figure(draw_verdicts(verdicts(results)), Path(results) / "verdicts.png")


def redraw_figures(results: str | Path, ids: Sequence[str]) -> None:
    """Draw the figures of stored results again; nothing is run."""
    from lifelore.figures.style import save_figure

    for claim_id in ids:
        folder = Path(results) / claim_id
        result = json.loads((folder / "result.json").read_text(encoding="utf-8"))
        save_figure(claim_of(claim_id).draw({**result, "rows": own_rows(result)}), folder / "figure.png")


if __name__ == "__main__":
    redraw_figures("results", sys.argv[1:])
    draw_summary("results")
    print(write_pages())
