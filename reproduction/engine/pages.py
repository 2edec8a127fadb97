"""Pages of the reproduction: one page that answers, one a chapter, and the gallery of the thesis's figures.

Run ``python -m reproduction.engine.pages`` after a full run; a test fails where pages and results differ. Ids of
claims as arguments (``… pages C2.5 C3.1``) draw their pictures again from the stored results.
"""

import json
import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from reproduction.engine.cell_store import write_atomically
from reproduction.engine.registry import CHAPTERS, RESULTS, ROOT, chapter_of, claim_ids, claim_of
from reproduction.engine.reproduce import draw, stored_result
from reproduction.engine.statement import HALF, UNTESTED, WORDS, filled, number_in_words

DOCS = ROOT.parent / "docs"
SUMMARY = ROOT / "summary.md"
"""Three sentences for the first page; ``{C3_2_first}`` becomes the measure ``first`` of claim C3.2."""
LINK = "../../reproduction/results"
"""The folder of the results as links of the pages see it."""
PICTURES = {
    "1.1": "assistive_robot", "3.17": "advised_walk", "3.19": "advice_system", "4.1": "reuse_model",
    "4.2": "reuse_curves", "4.7": "reuse_games", "4.13": "reuse_interaction",
}  # fmt: skip
"""Drawings of the thesis that show no measurement, by figure number: files of ``docs/pictures``."""
FIRST = "Generated from the stored results by `make reproduction-pages`."


def read_results(results: str | Path = RESULTS) -> list[dict]:
    """All stored results of a folder, in the order of the claims.

    Raises
    ------
    StoreError, InputError
        A result cannot be read, or is not JSON.
    """
    found = (stored_result(Path(results) / claim_id, claim_id) for claim_id in claim_ids())
    return [result for result in found if result is not None]


def render_pages(results: Sequence[Mapping]) -> dict[str, str]:
    """The pages as Markdown, by file name under ``docs``."""
    pages = {"reproduction/index.md": index_page(results), "reproduction/gallery.md": gallery(results)}
    for chapter, title in CHAPTERS.items():
        sections = [section(result) for result in results if chapter_of(result["claim"]) == chapter]
        if sections:
            pages[f"reproduction/{_file(chapter)}"] = "\n".join([f"# {title}", "", FIRST, "", *sections])
    return pages


def write_pages(folder: Path = DOCS) -> list[Path]:
    """Render the pages of the stored results and write them; returns their files."""
    pages = render_pages(read_results())
    for name, text in pages.items():
        write_atomically(folder / name, text)
    return [folder / name for name in pages]


def index_page(results: Sequence[Mapping]) -> str:
    """The first page: counts, what works and what does not, and a row a claim of the thesis."""
    thesis = [result for result in results if chapter_of(result["claim"]) in "234"]
    words = Counter(result["verdict"] for result in thesis)
    counts = " · ".join(f"{words[word]} {word}" for word in WORDS if words[word])
    tested = len(thesis) - words[UNTESTED]
    numbers = {
        f"{result['claim'].replace('.', '_')}_{name}": number
        for result in results
        for name, number in result["measured"].items()
    }
    return "\n".join([
        "# Does it reproduce?", "",
        FIRST, "",
        f"Of {tested} testable claims: **{counts}**.", "",
        filled(SUMMARY.read_text(encoding="utf-8").strip(), numbers), "",
        "Marks: at the default, under some reasonable reading of the choices left open, under most readings; "
        "½: in part or on average. A word links to the numbers. Run one: `lifelore reproduce 3.7 --full`.", "",
        "|figure|thesis|here|marks|word|", "|---|---|---|---|---|", *map(row, thesis), "",
        *_others(results), "",
    ])  # fmt: skip


def row(result: Mapping) -> str:
    """A claim as a row of the first page."""
    claim = claim_of(result["claim"])
    name = ", ".join(claim.figure) or claim.id
    link = f"{_file(chapter_of(claim.id))}#{anchor(claim.id)}"
    word = f"[{result['verdict']}]({LINK}/{claim.id}/result.json)"
    here = filled(claim.here, result["measured"])
    return f"|[{name}]({link})|{_cell(claim.thesis)}|{_cell(here)}|{claim_marks(result)}|{word}|"


def claim_marks(result: Mapping) -> str:
    """Three marks of a claim: those of its central statements where they agree, else `HALF`."""
    own = [result["marks"][one.says] for one in claim_of(result["claim"]).central]
    return "".join(marks[0] if len(set(marks)) == 1 else HALF for marks in zip(*own, strict=True))


def _others(results: Sequence[Mapping]) -> Iterator[str]:
    """A line of the ideas of chapter 5, and one of our own claims."""
    for chapter, words in (("5", "Ideas that the thesis proposes"), ("own", "Our own")):
        of = [result for result in results if chapter_of(result["claim"]) == chapter]
        links = [
            f"[{claim_of(one['claim']).title}]({_file(chapter)}#{anchor(one['claim'])}) {claim_marks(one)}"
            for one in of
        ]
        if links:
            yield f"{words}: {', '.join(links)}.\n"


def section(result: Mapping) -> str:
    """A claim on its chapter's page: its sentence, a row a statement, its figure, and what decides it."""
    claim, measured = claim_of(result["claim"]), result["measured"]
    where = f" ({', '.join(map(figure_name, claim.figure))})" if claim.figure else ""
    folder = f"{LINK}/{claim.id}"
    word = result["verdict"][0].upper() + result["verdict"][1:]
    lines = [
        f'<a id="{anchor(claim.id)}"></a>', "",
        f"## {claim.id} {claim.title}{where}", "",
        f"**{word}.** {claim.sentence} [Numbers]({folder}/result.json).", "",
        "|statement|here|marks|", "|---|---|---|",
    ]  # fmt: skip
    for one in claim.statements:
        number = measured.get(one.measure)
        marks = "".join(result["marks"][one.says])
        here = number_in_words(number) if number else "not measured"
        more = " (more runs needed)" if marks[0] == HALF else ""
        lines.append(f"|{_cell(one.says)}|{here}{more}|{marks}|")
    lines += ["", f"![{claim.id}]({folder}/figure.png)", ""]
    readings = f" [All readings]({folder}/readings.png)." if len(result["readings"]) > 2 else ""
    return "\n".join([*lines, f"{filled(claim.decides.strip(), measured)}{readings}", ""])


def gallery(results: Sequence[Mapping]) -> str:
    """Every figure that was drawn again, as the thesis numbers them; then claims without a figure."""
    found = {number: (f"../pictures/{name}.png", "") for number, name in PICTURES.items()}
    rest = {}
    for result in results:
        claim = claim_of(result["claim"])
        file = f"../../reproduction/results/{claim.id}/figure.png"
        words = f"[{claim.id}]({_file(chapter_of(claim.id))}#{anchor(claim.id)}) {claim.title}"
        for number in claim.figure:
            found.setdefault(number, (file, words))
        if not claim.figure:
            rest[claim.id] = (file, words)
    shown = [(figure_name(number), *found[number]) for number in sorted(found, key=_place)]
    return "\n".join([
        "# Gallery", "", FIRST, "",
        "Figures and tables as the thesis numbers them: the thesis's axes and curves, our numbers.", "",
        *_pictures(shown), "## Claims without a figure", "", *_pictures([("", *one) for one in rest.values()]),
    ])  # fmt: skip


def _cell(words: str) -> str:
    """Words as a cell of a table."""
    return words.replace("|", "\\|")


def figure_name(number: str) -> str:
    """``Figure 3.7`` of ``3.7``; a table has its full name already."""
    return number if number.startswith("Table") else f"Figure {number}"


def _place(number: str) -> tuple[int, int, bool]:
    """Where a figure (``3.7``) or table (``Table 3.1``) stands: by chapter and number, a figure before a table."""
    chapter, _, place = number.removeprefix("Table ").partition(".")
    return int(chapter), int(place), number.startswith("Table")


def _pictures(shown: Sequence[tuple[str, str, str]]) -> list[str]:
    """A table of pictures beside their words."""
    rows = [
        f"|{f'**{name}** {words}' if name else words}|![{name or words.partition(' ')[2]}]({file})|"
        for name, file, words in shown
    ]
    return ["| | |", "|---|---|", *rows, ""]


def anchor(claim_id: str) -> str:
    """The anchor of a claim's section: ``c3-4``."""
    return claim_id.replace(".", "-").lower()


def _file(chapter: str) -> str:
    return f"chapter{chapter}.md" if chapter.isdigit() else f"{chapter}.md"


def redraw(ids: Sequence[str], results: Path = RESULTS) -> None:
    """Draw the pictures of stored results again; nothing is run."""
    for claim_id in ids:
        result = json.loads((results / claim_id / "result.json").read_text(encoding="utf-8"))
        draw(claim_of(claim_id), result, results / claim_id)


if __name__ == "__main__":
    redraw(sys.argv[1:])
    print(*write_pages(), sep="\n")
