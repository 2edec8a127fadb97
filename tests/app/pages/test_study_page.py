"""The page of a study as a person uses it: without a study, and with traffic, uplift, policies and one user."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("fastapi", reason="needs the extra web")
pytest.importorskip("playwright", reason="needs the extra browser")

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page, expect

from lifelore.agent.personalise.decisions import Request, decide, observe
from lifelore.agent.personalise.study import Study
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.memory import open_memory

pytestmark = [pytest.mark.browser, pytest.mark.slow]

DESKTOP, PHONE = {"width": 1280, "height": 800}, {"width": 390, "height": 844}
MEANS = [[8.0, 2.0], [3.0, 9.0]]
LONG = "a rather long name of a policy that somebody chose without thought of a page"


@pytest.fixture
def where(tmp_path: Path) -> Path:
    """A memory with a study of two hundred users."""
    generator = np.random.default_rng(0)
    library = PolicyLibrary.from_means(MEANS, 2.0, ["calm", "lively"], ["slow", LONG])
    states = dict.fromkeys(library.policies, "active")
    with open_memory(tmp_path / "m.db") as memory:
        study = Study("playlists", library, states, control=0.3).keep(memory)
        users = [Request(f"<b>user/{number}</b>") for number in range(200)]
        for _ in range(3):
            made = decide(memory, study, users)
            outcomes = [
                (one["decision"], MEANS[number % 2][library.policies.index(one["policy"])] + generator.normal())
                for number, one in enumerate(made)
            ]
            observe(memory, study, outcomes)
    return tmp_path / "m.db"


def test_a_memory_without_a_study_says_how_to_begin(
    serve_pages: Callable[..., str], open_page: Callable[..., Page], tmp_path: Path
):
    page = open_page(serve_pages(memory=tmp_path / "empty.db") + "/study")
    expect(page.locator("#empty")).to_contain_text("lifelore reuse fit")
    expect(page.locator("#study")).to_be_hidden()


@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_a_study_is_shown_and_fits_its_window(
    serve_pages: Callable[..., str], open_page: Callable[..., Page], where: Path, size: dict[str, int]
):
    page = open_page(serve_pages(memory=where) + "/study", size)
    expect(page.locator("#traffic-words")).to_contain_text("600 decisions and 600 outcomes")
    expect(page.locator("#uplift")).to_contain_text("Control group")
    expect(page.locator("#policies")).to_contain_text(LONG)
    expect(page.locator("#calibration")).to_contain_text("uantiles")
    assert "study=playlists" in page.url
    found = Axe().run(page)
    assert found.violations_count == 0, found.generate_report()
    assert page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth") <= 0


def test_one_user_is_found_by_any_name(
    serve_pages: Callable[..., str], open_page: Callable[..., Page], where: Path
):
    page = open_page(serve_pages(memory=where) + "/study?study=playlists", PHONE)
    page.locator("#name").fill("<b>user/7</b>")
    page.locator("#ask button").click()
    expect(page.locator("#user")).to_contain_text("lively")
    expect(page.locator("#user b")).to_have_count(0)
    found = Axe().run(page)
    assert found.violations_count == 0, found.generate_report()
