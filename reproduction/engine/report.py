"""Pages of reproductions: every result under `results/`, rendered into `docs/reproduction/`, one page a chapter.

Run ``python -m reproduction.engine.report`` after a full run; a test fails where pages and results differ.
Ids of claims as arguments (``… report C2.5 C3.1``) draw their figures again from the stored results.
"""

import json
import sys
from collections.abc import Sequence
from pathlib import Path

from reproduction.engine import verify
from reproduction.engine.cell_store import write_atomically
from reproduction.engine.claim_section import claim_section, verdict_now
from reproduction.engine.index_page import CHAPTERS, chapter_of, index_page
from reproduction.engine.ledger import entries
from reproduction.engine.more_seeds import FILE
from reproduction.engine.registry import claim_of
from reproduction.engine.reproduce import own_rows, stored_result
from reproduction.engine.symbols import symbols

HOW_TO_READ = """[What a verdict means](index.md#what-a-verdict-means). A condition keeps its number in all
tables of its reading; in italics stands its name alone. The folded part of each claim has all conditions in words,
likely causes, the choices that the thesis leaves open, and the settings."""


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
    pages = {"index.md": index_page(found, verified(results), figures)}
    for number, title in CHAPTERS.items():
        sections = [claim_section(result, figures) for result in found if chapter_of(result["claim"]) == number]
        if sections:
            pages[f"chapter{number}.md"] = "\n".join(
                [f"# {title}", "", HOW_TO_READ, "", *symbols(number), *sections]
            )
    return pages


def write_pages(results: str | Path = "results", folder: str | Path = "docs/reproduction") -> Path:
    """Render the pages and write them; returns their folder."""
    folder = Path(folder)
    for name, text in render_pages(results).items():
        write_atomically(folder / name, text)
    return folder


def read_results(results: str | Path) -> list[dict]:
    """All results of a folder, in the ledger's order.

    Each has the pool of its seeds under ``seeds`` where several have run.

    Raises
    ------
    StoreError, InputError
        A result cannot be read, or is not JSON.
    """
    found = []
    for entry in entries():
        result = stored_result(Path(results) / entry.id, entry.id)
        if result is None:
            continue
        pool = Path(results) / entry.id / FILE
        found.append(result | ({"seeds": json.loads(pool.read_text(encoding="utf-8"))} if pool.exists() else {}))
    return found


def verified(results: str | Path) -> list[dict]:
    """What came of it when the results were last run again; empty where nobody has."""
    path = Path(results) / verify.FILE
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else []


def verdicts(results: str | Path) -> dict[str, list[tuple[str, str | None, str | None]]]:
    """By chapter: id, verdict of the first and of the second reading of every claim of the ledger."""
    found = {result["claim"]: result for result in read_results(results)}
    rooms: dict[str, list[tuple[str, str | None, str | None]]] = {title: [] for title in CHAPTERS.values()}
    for entry in entries():
        result = found.get(entry.id, {})
        second = verdict_now(result) if result.get("second") else None
        rooms[CHAPTERS[chapter_of(entry.id)]].append((entry.id, result.get("verdict"), second))
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
