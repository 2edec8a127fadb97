"""The page of a study as a person uses it: without a study, and with traffic, uplift, policies and one user."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("fastapi", reason="needs the extra web")
pytest.importorskip("playwright", reason="needs the extra browser")

from playwright.sync_api import expect

from lifelore.agent.personalise.decisions import Request, decide, observe
from lifelore.agent.personalise.study import Study
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.memory import open_memory

pytestmark = [pytest.mark.browser, pytest.mark.slow]

DESKTOP, PHONE = {"width": 1280, "height": 800}, {"width": 390, "height": 844}
MEANS = [[8.0, 2.0], [3.0, 9.0]]
LONG = "quiet music without voices for long evenings at home"


@pytest.fixture(scope="module")
def where(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A memory with a study of two hundred users."""
    generator = np.random.default_rng(0)
    library = PolicyLibrary.from_means(MEANS, 2.0, ["calm", "lively"], ["slow", LONG])
    states = dict.fromkeys(library.policies, "active")
    path = tmp_path_factory.mktemp("study") / "m.db"
    with open_memory(path) as memory:
        study = Study("playlists", library, states, control=0.3).keep(memory)
        users = [Request(f"<b>user/{number}</b>") for number in range(200)]
        for _ in range(3):
            made = decide(memory, study, users)
            outcomes = [
                (one["decision"], MEANS[number % 2][library.policies.index(one["policy"])] + generator.normal())
                for number, one in enumerate(made)
            ]
            observe(memory, study, outcomes)
    return path


def test_a_memory_without_a_study_says_how_to_begin(address, open_page):
    page = open_page(address + "/study")
    expect(page.locator("#empty")).to_contain_text("lifelore reuse fit")
    expect(page.locator("#study")).to_be_hidden()


@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_a_study_and_one_user_are_shown(serve_pages, open_page, check_page, where: Path, size: dict[str, int]):
    page = open_page(serve_pages(where) + "/study", size)
    expect(page.locator("#traffic-words")).to_contain_text("600 decisions and 600 outcomes")
    expect(page.locator("#uplift")).to_contain_text("Control group")
    expect(page.locator("#policies")).to_contain_text(LONG)
    expect(page.locator("#calibration")).to_contain_text("uantiles")
    assert "study=playlists" in page.url
    check_page(page, "study" if size is DESKTOP else None, 1120)
    page.locator("#name").fill("<b>user/7</b>")
    page.locator("#ask button").click()
    expect(page.locator("#user")).to_contain_text("lively")
    expect(page.locator("#user b")).to_have_count(0)
    check_page(page)
    for numbers in page.locator("summary").all():
        numbers.click()
    wide = "found => found.filter((one) => one.scrollWidth > one.clientWidth).map((one) => one.outerHTML)"
    assert page.locator(".scroll").evaluate_all(wide) == []


def test_the_first_outcome_of_a_study_is_drawn(serve_pages, open_page, tmp_path):
    library = PolicyLibrary.from_means(MEANS, 2.0, policies=["a", "b"])
    with open_memory(tmp_path / "m.db") as memory:
        study = Study("first", library, dict.fromkeys(library.policies, "active"), control=0.0).keep(memory)
        (made,) = decide(memory, study, [Request("ann")])
        observe(memory, study, [(made["decision"], 7.0312)])  # no round number
    page = open_page(serve_pages(tmp_path / "m.db") + "/study", DESKTOP)
    expect(page.locator("#traffic svg.picture")).to_have_count(2)
    drawn = page.locator("#traffic").inner_html()
    assert "NaN" not in drawn
    assert "Infinity" not in drawn


def test_the_study_of_the_command_line_is_shown_first(serve_pages, open_page, tmp_path):
    library = PolicyLibrary.from_means(MEANS, 2.0, policies=["a", "b"])
    with open_memory(tmp_path / "m.db") as memory:
        for name in ("another", "default"):
            Study(name, library, {"a": "active", "b": "active"}).keep(memory)
    page = open_page(serve_pages(tmp_path / "m.db") + "/study")
    expect(page.locator("#which")).to_have_value("default")
