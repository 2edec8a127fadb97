"""The gallery shows every figure once, with words, and is what its function renders."""

import re
from pathlib import Path

import pytest

from lifelore.core.errors import NotFoundError
from reproduction.engine.gallery import render_gallery, write_gallery
from reproduction.engine.report import read_results

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "gallery.md"
TEXT = PAGE.read_text(encoding="utf-8")


def test_the_page_is_what_the_function_renders():
    assert render_gallery(ROOT) == TEXT, "run: python -m reproduction.engine.gallery"


def test_every_figure_is_shown_once_with_words():
    shown = re.findall(r"!\[([^\]]+)\]\(([^)]+)\)", TEXT)
    files = [(PAGE.parent / target).resolve() for _, target in shown]
    every = [*(ROOT / "results").rglob("*.png"), *(ROOT / "docs" / "pictures").glob("*.png")]
    assert sorted(files) == sorted(path.resolve() for path in every)
    assert all(len(words) > 10 for words, _ in shown)


def test_its_links_lead_to_sections():
    links = re.findall(r"(?<!!)\[[^\]]+\]\(([^)]+)\)", TEXT)
    assert links
    for link in links:
        name, _, anchor = link.partition("#")
        assert not anchor or f'<a id="{anchor}"></a>' in (PAGE.parent / name).read_text(encoding="utf-8")
        assert (PAGE.parent / name).is_file()


def test_verdicts_are_those_of_the_seeds_together():
    together = {
        result["claim"]: result["seeds"]["verdict"]
        for result in read_results(ROOT / "results")
        if "seeds" in result
    }
    assert together
    for claim, verdict in together.items():
        assert re.search(rf"\| \[{re.escape(claim)}\]\([^|]*: {verdict} \|", TEXT), claim


def made(root: Path, figures: dict[str, str], page: str) -> Path:
    for name in figures:
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_bytes(b"")
    (root / "docs").mkdir(exist_ok=True)
    (root / "docs" / "hall.md").write_text(page, encoding="utf-8")
    return root


def test_a_figure_stands_under_its_page_with_the_words_of_the_page(tmp_path):
    figures = dict.fromkeys(["docs/pictures/hall.png", "results/bench_doors.png", "results/bench_floors.png"], "")
    root = made(
        tmp_path, figures, "# The hall\n![A hall](pictures/hall.png) [figure](../results/bench_floors.png)\n"
    )
    text = write_gallery(root).read_text(encoding="utf-8")
    page, benchmarks = text.split("## Benchmarks that no page shows")
    assert "## [The hall](hall.md)" in page
    shown = "| ![A hall](pictures/hall.png) | ![lifelore bench floors](../results/bench_floors.png) |"
    assert f"{shown}\n| A hall | `lifelore bench floors` |" in page
    assert "![lifelore bench doors](../results/bench_doors.png)" in benchmarks
    assert "| `lifelore bench doors` |" in benchmarks


def test_a_figure_without_words_is_named(tmp_path):
    root = made(tmp_path, {"results/lost/picture.png": ""}, "# The hall\n")
    with pytest.raises(NotFoundError, match=r"results/lost/picture\.png has no words; show it on a page"):
        render_gallery(root)
