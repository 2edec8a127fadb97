"""The pictures of the page guide, each made from a page in use.

`LIFELORE_PICTURES=docs/pictures python -m pytest tests/app/pages/test_page_pictures.py` makes them again. Names
and draws are fixed, so a picture changes with its page.
"""

import os
from collections.abc import Callable
from pathlib import Path

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")
pytest.importorskip("playwright", reason="needs the extra browser")

from playwright.sync_api import Page, expect

from lifelore.agent.long_lived.long_life import live_long
from lifelore.app.pages.shell.page_shell import PAGES

pytestmark = [pytest.mark.browser, pytest.mark.slow]

MOST_BYTES = 300_000
"""Bytes of the largest picture of the documentation."""
LOADED = 60_000
"""Milliseconds for what a page prepares: a scene."""

Save = Callable[..., None]


@pytest.fixture
def save(tmp_path: Path) -> Save:
    """Save a picture of the page, or of a part, in the folder of LIFELORE_PICTURES."""
    folder = Path(os.environ.get("LIFELORE_PICTURES") or tmp_path).absolute()

    def save(page: Page, name: str, part: str | None = None, whole: bool = False) -> None:
        titles = page.get_by_role("navigation").get_by_role("link").all_inner_texts()
        assert [one.title for one in PAGES] == [title for title in titles if title != "Lifelore"]
        wide = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
        assert wide <= 0
        file = folder / f"page_{name}.png"
        if part is None:
            page.screenshot(path=file, full_page=whole)
        else:
            page.locator(part).screenshot(path=file)
        assert file.stat().st_size < MOST_BYTES

    return save


def tall(height: int) -> dict[str, int]:
    return {"width": 1280, "height": height}


def test_see(serve_pages: Callable[..., str], open_page: Callable[..., Page], save: Save):
    page = open_page(f"{serve_pages()}/see", tall(1120))
    expect(page.locator("#summary")).to_contain_text("3 objects", timeout=LOADED)
    page.get_by_role("button", name="Object 3").click()
    expect(page.locator("#details")).to_contain_text("Carries")
    save(page, "see")


def test_life(serve_pages: Callable[..., str], open_page: Callable[..., Page], save: Save, tmp_path: Path):
    where = tmp_path / "life.db"
    live_long("factory-customers", tasks=20, memory=where)
    page = open_page(f"{serve_pages(memory=where)}/life", tall(1240))
    expect(page.locator("#summary")).to_contain_text("has lived 20 tasks", timeout=LOADED)
    save(page, "life")
