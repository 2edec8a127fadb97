"""The pictures of the page guide, each made from a page in use.

`LIFELORE_PICTURES=docs/pictures python -m pytest tests/app/pages/test_page_pictures.py` makes them again. Names
and draws are fixed, so a picture changes with its page, and with the time of its frame on /play and /teach.
"""

import os
import re
from collections.abc import Callable
from pathlib import Path

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")
pytest.importorskip("playwright", reason="needs the extra browser")

from playwright.sync_api import Page, expect

from lifelore.agent.factory_lesson.lesson_task import lesson_task
from lifelore.agent.long_lived.long_life import live_long
from lifelore.agent.play_study.scripted_sessions import play_scripted_sessions
from lifelore.agent.play_study.study_settings import StudySettings
from lifelore.app.pages.shell.page_shell import PAGES
from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import SIZES, ball_game
from lifelore.domains.ball_game.simulated_player import choose_heading
from lifelore.memory import open_memory

pytestmark = [pytest.mark.browser, pytest.mark.slow]

OFFICE = Path(__file__).parents[3] / "examples" / "data" / "office.yaml"
ARROWS = ("ArrowUp", "ArrowDown", "ArrowRight", "ArrowLeft")
MOVES: dict[str, str] = dict(zip(("north", "south", "east", "west"), ARROWS, strict=True))
MOST_BYTES = 300_000
"""Bytes of the largest picture of the documentation."""
LOADED = 60_000
"""Milliseconds for what a page prepares: a building, a scene, learners."""

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


def test_play(serve_pages: Callable[..., str], open_page: Callable[..., Page], save: Save):
    page = open_page(f"{serve_pages()}/play", tall(980))
    page.wait_for_selector("#size option", state="attached")
    page.select_option("#size", "40")
    page.check("#show-belief")
    page.click("#free")
    field, pressed = ball_game().field, None
    page.wait_for_selector("#field[data-running=true]")
    while int((state := page.evaluate("({...document.getElementById('field').dataset})")).get("moves", 0)) < 22:
        heading = int(
            choose_heading(field, SIZES.index(40), round(float(state["x"])), round(float(state["y"])), 50)
        )
        if heading != pressed:
            page.keyboard.press(ARROWS[heading])
            pressed = heading
    expect(page.locator("#belief-rows tr")).to_have_count(len(SIZES))
    page.evaluate("window.scrollTo(0, 0)")
    save(page, "play")


def test_results_of_play(
    serve_pages: Callable[..., str], open_page: Callable[..., Page], save: Save, tmp_path: Path
):
    where = tmp_path / "played.db"
    with open_memory(where) as memory:
        # The numbers of the whole sessions are those of tests/agent/play_study/test_scripted_sessions.py.
        length = "thesis" if os.environ.get("LIFELORE_PICTURES") else "short"
        play_scripted_sessions(memory, 4, StudySettings.of_length(length, "scripted"))
    page = open_page(f"{serve_pages(memory=where)}/play#results")
    expect(page.locator("#groups figure")).to_have_count(3, timeout=LOADED)
    expect(page.locator("#results-message")).to_contain_text("People untested")
    expect(page.locator("#groups h3")).to_have_text("Scripted players (no people)")
    expect(page.locator("#groups")).to_contain_text("4 sessions, 4 finished")
    save(page, "play_results", "#results")


def test_teach(serve_pages: Callable[..., str], open_page: Callable[..., Page], save: Save):
    page = open_page(f"{serve_pages()}/teach", tall(800))
    page.click("#begin")
    page.wait_for_selector("#lesson-panel:not([hidden])")
    lesson = page.inner_text("#identifier")
    for number in range(3):
        task = lesson_task(0, lesson, 2, "shown", number)
        state, steps = int(task.tables.starts[0]), 0
        while task.best[state].any() and (number < 2 or steps < 12):
            action = int(task.best[state].argmax())
            page.keyboard.press((*ARROWS, "p", "a")[action])
            state, steps = int(task.tables.next_state[state, action, 0]), steps + 1
        page.wait_for_selector(f"#floor[data-steps='{steps}']", timeout=LOADED)
        if number < 2:
            page.wait_for_selector("#next:focus", timeout=LOADED)
        if number == 1:
            whole = "() => document.getElementById('curves').dataset.episodes === '100'"
            page.wait_for_function(whole, timeout=2 * LOADED)
        if number < 2:
            page.keyboard.press("Enter")
            page.wait_for_selector("#floor[data-over='false']")
    expect(page.locator("#learning-status")).to_contain_text("2 demonstrations")
    save(page, "teach", whole=True)


def test_walk(serve_pages: Callable[..., str], open_page: Callable[..., Page], save: Save):
    """A wanderer, who walks straight on with probability 0.85 and does not follow the advice."""
    page = open_page(f"{serve_pages('--map', f'office={OFFICE}')}/", tall(860))
    page.add_init_script("crypto.getRandomValues = (numbers) => numbers.fill(8);")
    page.goto(page.url + "walk")
    page.get_by_role("button", name="New start").click()
    errand = page.locator("#errand")
    expect(errand).to_have_text(re.compile("0 steps"), timeout=LOADED)
    random, heading, steps = stream(0, "a picture of a walk"), "", 0
    while steps < 50 or page.locator("#moves button.advised").count() < 2:
        ways = [move for move in MOVES if move in page.locator("#seen").inner_text().split(".")[0]]
        if heading not in ways or random.random() > 0.85:
            heading = ways[int(random.integers(len(ways)))]
        page.keyboard.press(MOVES[heading])
        steps += 1
        expect(errand).to_contain_text(f"· {steps} step")
    expect(page.locator("#counsel")).to_contain_text("Advice: ")
    page.evaluate("document.activeElement.blur()")
    save(page, "walk")


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
