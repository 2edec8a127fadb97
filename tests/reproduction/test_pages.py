"""The pages are those of the stored results, short, and their links lead somewhere."""

import re

import pytest

from reproduction.engine.pages import DOCS, anchor, claim_marks, read_results, render_pages
from reproduction.engine.registry import CHAPTERS, chapter_of, claim_of

RESULTS = read_results()
PAGES = render_pages(RESULTS)
MOST_WORDS = {
    "reproduction/index.md": 710, "reproduction/chapter2.md": 1300, "reproduction/chapter3.md": 2000,
    "reproduction/chapter4.md": 1700, "reproduction/chapter5.md": 1000, "reproduction/own.md": 900,
}  # fmt: skip


@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_that_of_the_stored_results(name):
    assert (DOCS / name).read_text(encoding="utf-8") == PAGES[name], "run `make reproduction-pages`"


@pytest.mark.parametrize(("name", "most"), MOST_WORDS.items())
def test_a_page_is_short(name, most):
    assert len(PAGES[name].split()) <= most


@pytest.mark.parametrize("name", PAGES)
def test_files_and_anchors_that_a_page_links_to_exist(name):
    for target in re.findall(r"\]\(([^)\s]+)\)", PAGES[name]):
        file, _, part = target.partition("#")
        path = (DOCS / name).parent / file
        assert path.is_file(), target
        if part:
            assert f'<a id="{part}"></a>' in path.read_text(encoding="utf-8"), target


def test_every_claim_has_its_section_and_its_place_on_the_first_page():
    for result in RESULTS:
        claim = claim_of(result["claim"])
        chapter = chapter_of(claim.id)
        page = PAGES[f"reproduction/{'chapter' * chapter.isdigit()}{chapter}.md"]
        assert f'<a id="{anchor(claim.id)}"></a>\n\n## {claim.id} ' in page
        assert f"#{anchor(claim.id)})" in PAGES["reproduction/index.md"]
    assert len(CHAPTERS) == 5


def test_the_gallery_is_in_the_thesis_s_order():
    names = re.findall(r"\*\*(Figure|Table) (\d)\.(\d+)", PAGES["reproduction/gallery.md"])
    places = [(int(chapter), int(number), kind) for kind, chapter, number in names]
    assert places == sorted(set(places))
    assert {(3, 3), (3, 7), (4, 8), (4, 10), (4, 16)} <= {place[:2] for place in places}


def test_marks_of_a_claim_are_those_of_its_central_statements(monkeypatch):
    claim = claim_of("C3.1")
    central = claim.central[0].says
    assert claim_marks({"claim": "C3.1", "marks": {central: ["✓", "½", "✗"]}}) == "✓½✗"
