"""The page /play in Chromium: a script plays a whole session by keys, and its rounds give the figures."""

from collections.abc import Callable

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")
pytest.importorskip("playwright", reason="needs the extra browser")

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page

from lifelore.domains.ball_game.ball_game import SIZES, ball_game
from lifelore.domains.ball_game.simulated_player import choose_heading

pytestmark = [pytest.mark.browser, pytest.mark.slow]

FIELD = ball_game().field
KEYS = ("ArrowUp", "ArrowDown", "ArrowRight", "ArrowLeft")
STATE = "({...document.getElementById('field').dataset})"
PHONE = {"width": 390, "height": 844}


def play_round(page: Page) -> None:
    """Press the keys that the thesis's simulated user chooses at the drawn place, until the round is over."""
    page.wait_for_selector("#field[data-running=true]")
    pressed = None
    while (state := page.evaluate(STATE))["running"] == "true":
        place = round(float(state["x"])), round(float(state["y"]))
        heading = int(choose_heading(FIELD, SIZES.index(int(state["size"])), *place, 50))
        if heading != pressed:
            page.keyboard.press(KEYS[heading])
            pressed = heading


def press(page: Page, selector: str, key: str = "Enter") -> None:
    page.focus(selector)
    page.keyboard.press(key)


def test_a_script_plays_a_whole_session_by_keyboard(
    serve_pages: Callable[..., str], open_page: Callable[..., Page]
):
    address = serve_pages()
    page = open_page(f"{address}/play")
    page.wait_for_selector("#length option", state="attached")
    assert page.is_disabled("#begin")
    assert "not the approval of an ethics committee" in page.inner_text("#consent-text")
    press(page, "#consent", "Space")
    press(page, "details summary", "Space")
    page.select_option("#player", "scripted")
    page.fill("#pace", "1")
    press(page, "#begin")
    page.wait_for_selector("#next-panel:not([hidden])")
    rounds, texts = 0, []
    while page.is_visible("#next"):
        page.wait_for_selector("#next:not([disabled])")
        assert page.evaluate("document.activeElement.id") == "next"  # Enter alone goes on to the next round
        page.keyboard.press("Enter")
        page.wait_for_selector("#field[data-running=true]")
        texts.append((page.get_attribute("#field", "data-phase"), page.inner_text("#round")))
        play_round(page)
        rounds += 1
        page.wait_for_function("n => /stored/.test(document.getElementById('round').textContent)", arg=rounds)
    assert [phase for phase, _ in texts] == ["practice"] + 9 * ["training"] + 6 * ["test"]
    assert all(("speed" in text) == (phase != "test") for phase, text in texts)
    assert "All 16 rounds are played and stored" in page.inner_text("#progress")

    session = page.inner_text("#identifier")
    record = page.request.get(f"{address}/v1/play/sessions/{session}/record").json()
    assert [row["number"] for row in record["rounds"]] == list(range(16))
    assert all(row["reached"] for row in record["rounds"])
    with page.expect_download() as download:
        press(page, "#csv")
    assert download.value.suggested_filename == f"play_{session}.csv"

    press(page, "#show-results")
    page.wait_for_selector("#groups figure")
    assert "People untested" in page.inner_text("#results-message")
    assert "Scripted players (no people)" in page.inner_text("#groups h3")
    assert "3 pairs of blocks" in page.inner_text("#groups")
    assert page.locator("#groups figure svg[role=img]").count() == 3
    found = Axe().run(page)
    assert found.violations_count == 0, found.generate_report()
    page.reload()
    page.wait_for_selector("#next-panel:not([hidden])")  # the player comes back to the finished session
    page.on("dialog", lambda dialog: dialog.accept())
    press(page, "#delete")
    page.wait_for_selector("#consent-panel:not([hidden])")
    assert page.request.get(f"{address}/v1/play/sessions/{session}").status == 404


def test_a_free_round_by_touch_with_the_belief(serve_pages: Callable[..., str], open_page: Callable[..., Page]):
    page = open_page(f"{serve_pages()}/play", PHONE)
    page.wait_for_selector("#size option", state="attached")
    page.check("#show-belief")
    page.click("#free")
    page.wait_for_selector("#field[data-running=true]")
    page.click("[data-heading='2']")
    page.wait_for_function("() => Number(document.getElementById('field').dataset.moves) > 5")
    assert page.locator("#belief-rows tr").count() == 6
    assert page.inner_text("#speed") in ("30", "40", "50", "60", "70")
    page.wait_for_function("() => /collisions [1-9]/.test(document.getElementById('where').textContent)")


def test_a_round_that_is_stopped_begins_again(serve_pages: Callable[..., str], open_page: Callable[..., Page]):
    page = open_page(f"{serve_pages()}/play")
    page.wait_for_selector("#size option", state="attached")
    page.check("#consent")
    page.click("#begin")
    for _ in range(2):
        page.wait_for_selector("#next:not([disabled])")
        page.click("#next")
        page.wait_for_selector("#field[data-running=true]")
        page.keyboard.press("ArrowRight")
        page.wait_for_function("() => Number(document.getElementById('field').dataset.moves) > 2")
        page.keyboard.press("Escape")
        assert page.get_attribute("#field", "data-running") == "false"
    assert "round 1 of 16" in page.inner_text("#progress")
    page.click("#free")  # over a socket of its own
    page.wait_for_selector("#field[data-phase=free][data-running=true]")


def test_an_empty_memory_says_what_to_do(serve_pages: Callable[..., str], open_page: Callable[..., Page]):
    page = open_page(f"{serve_pages()}/play#results")
    page.wait_for_selector("#results-message:not([hidden])")
    assert "begin the study above" in page.inner_text("#results-message")
    assert "People untested" in page.inner_text("#results-message")
