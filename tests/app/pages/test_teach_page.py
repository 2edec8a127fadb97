"""The page /teach: its routes, and a whole lesson by keyboard in Chromium."""

from collections.abc import Callable, Iterator

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")
pytest.importorskip("playwright", reason="needs the extra browser")

from axe_playwright_python.sync_playwright import Axe
from fastapi.testclient import TestClient
from playwright.sync_api import Page

from lifelore.agent.factory_lesson.lesson_task import lesson_task
from lifelore.app.pages.mount import app_with_pages
from lifelore.app.service.settings import ServiceSettings

KEYS = ("ArrowUp", "ArrowDown", "ArrowRight", "ArrowLeft", "p", "a")
PHONE = {"width": 390, "height": 844}


def best_actions(lesson: str, components: int, number: int) -> list[int]:
    """The actions of an optimal policy from the start to the end of a task."""
    task = lesson_task(0, lesson, components, "shown", number)
    state, actions = int(task.tables.starts[0]), []
    while task.best[state].any():
        actions.append(int(task.best[state].argmax()))
        state = int(task.tables.next_state[state, actions[-1], 0])
    return actions


@pytest.fixture
def client(tmp_path) -> Iterator[TestClient]:
    settings = ServiceSettings(str(tmp_path / "m.db"), rate=0.0)
    with TestClient(app_with_pages(settings), base_url="http://127.0.0.1") as client:
        yield client


def test_a_lesson_over_http(client):
    begun = client.post("/v1/teach/lessons", json={"components": 1}).json()
    lesson = begun["lesson"]
    assert len(begun["floor"]) == 22
    view = begun
    for action in best_actions(lesson, 1, 0):
        view = client.post(f"/v1/teach/lessons/{lesson}/steps", json={"action": action}).json()
    assert (view["over"], view["shown"]) == (True, 1)
    refused = client.post(f"/v1/teach/lessons/{lesson}/steps", json={"action": 0})
    assert refused.status_code == 422
    assert "over" in refused.json()["error"]["message"]
    curves = client.post(f"/v1/teach/lessons/{lesson}/curves", json={"episodes": 5}).json()["curves"]
    assert len(curves) == 3
    following = client.post(f"/v1/teach/lessons/{lesson}/next").json()
    assert (following["number"], following["steps"], following["memory"]["demonstrations"]) == (1, 0, 1)
    assert len(client.get(f"/v1/teach/lessons/{lesson}/record").text.splitlines()) == view["steps"] + 1
    assert client.delete(f"/v1/teach/lessons/{lesson}").json()["forgotten"] == 2
    assert client.get(f"/v1/teach/lessons/{lesson}").status_code == 404


@pytest.mark.parametrize(
    ("path", "body", "status"),
    [
        ("", {"components": 0}, 422),
        ("", {"components": 5}, 422),
        ("", {"parts": 1}, 422),
        ("/nobody/steps", {"action": 1}, 404),
        ("/nobody/steps", {"action": 6}, 422),
        ("/nobody/curves", {"episodes": 101}, 422),
        ("/nobody/curves", {"episodes": 5}, 404),
        ("/nobody/next", None, 404),
    ],
)
def test_requests_that_are_refused(client, path, body, status):
    answer = client.post(f"/v1/teach/lessons{path}", json=body)
    assert answer.status_code == status
    assert answer.json()["error"]["message"]


def teach(page: Page, components: int, number: int) -> None:
    """Demonstrate a task by keys."""
    lesson = page.inner_text("#identifier")
    actions = best_actions(lesson, components, number)
    for action in actions:
        page.keyboard.press(KEYS[action])
    page.wait_for_selector("#floor[data-over='true']")
    assert page.get_attribute("#floor", "data-steps") == str(len(actions))


@pytest.mark.browser
@pytest.mark.slow
def test_a_whole_lesson_by_keyboard(serve_pages: Callable[..., str], open_page: Callable[..., Page]):
    address = serve_pages()
    page = open_page(f"{address}/teach")
    page.wait_for_load_state("networkidle")
    assert "begin a lesson" in page.inner_text("#status")
    page.focus("#begin")
    page.keyboard.press("Enter")
    page.wait_for_selector("#lesson-panel:not([hidden])")
    assert page.evaluate("document.activeElement.id") == "floor"
    assert "You have not shown such a place" in page.inner_text("#advised")
    for number in range(2):
        teach(page, 2, number)
        assert page.inner_text("#items").count("assembled") == 2
        page.wait_for_selector("#next:focus")
        page.wait_for_function(
            "() => document.getElementById('curves').dataset.episodes === '100'", timeout=120_000
        )
        words = f"with a prior from {number + 1} demonstration"
        page.wait_for_function(
            "words => document.getElementById('learning-status').textContent.includes(words)", arg=words
        )
        page.keyboard.press("Enter")
        page.wait_for_selector("#floor[data-over='false']")
    assert Axe().run(page).violations_count == 0
    legend = page.inner_text("#curves .legend")
    assert "without a prior" in legend
    assert "with your prior" in legend
    assert page.locator("#curves svg[role=img] path").count() == 3
    assert page.locator("#advice-rows tr").count() == 6
    lesson = page.inner_text("#identifier")
    with page.expect_download() as download:
        page.focus("#record")
        page.keyboard.press("Enter")
    assert download.value.suggested_filename == f"teach_{lesson}.jsonl"
    page.reload()
    page.wait_for_selector("#floor[data-shown='2']")  # the person comes back to the lesson
    page.on("dialog", lambda dialog: dialog.accept())
    page.focus("#delete")
    page.keyboard.press("Enter")
    page.wait_for_selector("#begin-panel:not([hidden])")
    assert page.request.get(f"{address}/v1/teach/lessons/{lesson}").status == 404


@pytest.mark.browser
@pytest.mark.slow
def test_a_wall_by_touch(serve_pages: Callable[..., str], open_page: Callable[..., Page]):
    page = open_page(f"{serve_pages()}/teach", PHONE)
    page.select_option("#components", "1")
    page.click("#begin")
    page.wait_for_selector("#work:not([hidden])")
    for _ in range(20):
        page.click("[data-action='1']")
    page.wait_for_selector("#floor[data-steps='20']")
    assert "wall" in page.inner_text("#status")
    page.click("[data-action='4']")
    page.wait_for_selector("#floor[data-steps='21']")
    page.click("#skip")
    page.wait_for_selector("#floor[data-number='1']")
