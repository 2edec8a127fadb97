"""The page life as a person uses it: an empty memory, both kinds of lives, keys, and a life that goes on."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")
pytest.importorskip("playwright", reason="needs the extra browser")

from fastapi.testclient import TestClient
from playwright.sync_api import Browser, Dialog, Page, expect

from lifelore.agent.live.goals.destinations import Destination
from lifelore.agent.live.goals.job_list import Job
from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.agent.long_lived.long_life import live_long
from lifelore.app import ServiceSettings, app_with_pages
from lifelore.app.service.tokens import add_token
from lifelore.domains.worlds import WorldSettings
from lifelore.memory import open_memory

pytestmark = [pytest.mark.browser, pytest.mark.slow]

DESKTOP, PHONE = {"width": 1280, "height": 800}, {"width": 390, "height": 844}
FACTORY = "factory-customers"

Opened = Callable[..., Page]


def serve_customers(where: Path, n_tasks: int) -> dict:
    """Live through some orders of the factory."""
    return live_long(FACTORY, tasks=n_tasks, episodes=3, robot="bo", memory=where)


def walk_lattice(where: Path, n_tasks: int) -> dict:
    """Live through some tasks of a small lattice."""
    memory = MemorySettings(str(where), "ada")
    return live(LifeSettings(WorldSettings("lattice", size=9), memory=memory, tasks=n_tasks, jobs=1)).report


@pytest.fixture
def where(tmp_path: Path) -> Path:
    return tmp_path / "m.db"


def test_an_empty_memory_says_how_to_begin_and_shows_the_first_task(
    serve_pages: Callable[..., str], open_page: Opened, where: Path
):
    page = open_page(serve_pages(where) + "/life")
    expect(page.locator("#empty")).to_contain_text("lifelore live --domain factory-customers")
    expect(page.locator("#life")).to_be_hidden()
    serve_customers(where, 1)
    expect(page.locator("#task-title")).to_have_text("Task 0")
    expect(page.locator("#empty")).to_be_hidden()
    expect(page.locator("#task-context")).to_contain_text("The agent knew no type yet.")


def test_a_life_of_hidden_types_by_keyboard_and_while_it_goes_on(
    serve_pages: Callable[..., str], open_page: Opened, where: Path
):
    report = serve_customers(where, 5)
    page = open_page(serve_pages(where) + "/life")
    expect(page.locator("#task-title")).to_have_text("Task 4")
    expect(page.locator("#summary")).to_contain_text("bo has lived 5 tasks of factory-customers.")
    last = report["tasks"][4]
    reasons = page.locator("#why li")
    expect(reasons).to_have_count(len(last["first_episode"]))
    expect(reasons.first).to_contain_text(f"as for {last['first_episode'][0]['as_for']}")
    expect(page.locator("#beliefs rect")).not_to_have_count(0)
    expect(page.locator("#expects .expected")).to_have_count(len({task["context"] for task in report["tasks"]}))
    expect(page.locator("#types details")).not_to_have_count(0)
    page.locator("#types summary").first.press("Enter")
    expect(page.locator("#types details").first.locator("li").first).to_contain_text("component")
    earlier = page.get_by_role("button", name="Earlier task")
    earlier.focus()
    page.keyboard.press("Enter")
    expect(page.locator("#task-title")).to_have_text("Task 3")
    follow = page.get_by_label("Follow the newest task")
    expect(follow).not_to_be_checked()
    serve_customers(where, 1)  # the chosen task stays
    expect(page.locator("#summary")).to_contain_text("6 tasks")
    expect(page.locator("#task-title")).to_have_text("Task 3")
    follow.focus()
    page.keyboard.press("Space")
    expect(page.locator("#task-title")).to_have_text("Task 5")
    serve_customers(where, 1)  # and now the newest is followed
    expect(page.locator("#task-title")).to_have_text("Task 6")
    page.locator("#task").select_option("0")
    expect(page.locator("#task-title")).to_have_text("Task 0")


def test_a_life_on_a_map_has_arrows_and_curves(serve_pages: Callable[..., str], open_page: Opened, where: Path):
    report = walk_lattice(where, 4)
    page = open_page(serve_pages(where) + "/life")
    expect(page.locator("#map-words")).to_contain_text("known places of a map of 9 by 9 cells")
    assert len(page.locator("#map path[opacity]").all()) > 0
    expect(page.locator("#map circle")).to_have_count(len({tuple(task["goal"]) for task in report["tasks"]}))
    expect(page.locator("#curve circle")).to_have_count(2 * 4)  # the agent and scratch, in each task
    rows = page.locator("#list tbody tr")
    expect(rows).to_have_count(4)
    expect(rows.first).to_have_class("chosen")
    whole = page.locator("#map svg").get_attribute("viewBox")
    page.select_option("#part", "near")
    expect(page.locator("#map svg")).not_to_have_attribute("viewBox", whole or "")
    page.get_by_role("button", name="Earlier task").click()
    expect(page.locator("#map-words")).to_contain_text("The filled circle is the goal of task 2")
    walk_lattice(where, 1)
    expect(page.locator("#summary")).to_contain_text("5 tasks")


def test_a_life_of_drives_shows_metres_and_seconds(serve_pages, open_page: Opened, check_page, where: Path):
    jobs = (Job(Destination((20.875, 6.025), "the far end of the office")),) * 2
    settings = LifeSettings(WorldSettings(), memory=MemorySettings(str(where), "ada"), goals=jobs)
    live(settings)
    page = open_page(serve_pages(where) + "/life", PHONE)
    expect(page.locator("#curve circle")).to_have_count(2 * 2)  # with memory and on the map alone
    expect(page.locator("#curve-words")).to_contain_text("the seconds of each drive to a known goal")
    expect(page.locator("#list tbody tr").first).to_contain_text(re.compile(r"\d m in [\d.]+ s"))
    picture, *marks = page.evaluate(
        """[document.querySelector("#map svg"), ...document.querySelectorAll("#map circle, #map text")]
            .map((one) => one.getBoundingClientRect())
            .map((box) => [box.left, box.top, -box.right, -box.bottom])"""
    )
    assert marks
    assert all(mark >= edge - 1 for box in marks for mark, edge in zip(box, picture, strict=True))
    check_page(page)


def test_a_life_that_remembers_no_map_says_so(serve_pages: Callable[..., str], open_page: Opened, where: Path):
    memory = MemorySettings(str(where), "ada")
    live(LifeSettings(WorldSettings("lattice", size=7), agent="prior", memory=memory, tasks=1, jobs=1))
    page = open_page(serve_pages(where) + "/life")
    expect(page.locator("#map")).to_have_text("This agent remembers no map.")
    expect(page.locator("#curve circle")).to_have_count(2)


def test_a_life_that_grows_is_shown_where_another_was(
    serve_pages: Callable[..., str], open_page: Opened, where: Path
):
    walk_lattice(where, 2)
    serve_customers(where, 1)
    page = open_page(serve_pages(where) + "/life")
    expect(page.locator("#summary")).to_contain_text("ada has lived 2 tasks of lattice.")
    serve_customers(where, 1)
    expect(page.locator("#summary")).to_contain_text("bo has lived 2 tasks")
    page.select_option("#which", index=0)
    expect(page.locator("#summary")).to_contain_text("ada has lived 2 tasks of lattice.")


@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_both_kinds_of_lives_are_accessible_and_fit(
    serve_pages, open_page: Opened, check_page, where: Path, size: dict[str, int]
):
    walk_lattice(where, 3)
    live_long(FACTORY, tasks=20 if size is DESKTOP else 3, memory=where)
    page = open_page(serve_pages(where) + "/life", size)
    for index, panel in enumerate(("#of-map", "#of-types")):
        page.select_option("#which", index=index)
        expect(page.locator(panel)).to_be_visible()
        hidden = "found => found.filter((one) => one.scrollWidth > one.clientWidth).map((one) => one.outerHTML)"
        assert page.locator(".scroll:visible").evaluate_all(hidden) == []
        check_page(page, "life" if (size, panel) == (DESKTOP, "#of-types") else None, 1240)


def test_a_service_with_tokens_asks_once(
    serve_pages: Callable[..., str], browser: Browser, where: Path, tmp_path: Path
):
    # Not by `open_page`: the browser itself logs each answer that is an error.
    serve_customers(where, 1)
    token = add_token(str(tmp_path / "tokens"), "ada", ["read"])
    address = serve_pages(where, token_file=str(tmp_path / "tokens"))
    questions: list[str] = []
    with browser.new_context(viewport=DESKTOP) as context:  # pyright: ignore[reportArgumentType]
        page = context.new_page()

        def dismiss(dialog: Dialog) -> None:
            questions.append(dialog.message)
            dialog.dismiss()

        page.on("dialog", dismiss)
        page.goto(address + "/life")
        expect(page.locator("#message")).to_contain_text("the request needs a token")
        page.wait_for_timeout(2500)  # two looks at memory would have come
        assert len(questions) == 1
    with browser.new_context(viewport=DESKTOP) as context:  # pyright: ignore[reportArgumentType]
        page = context.new_page()
        page.on("dialog", lambda dialog: dialog.accept(token))
        page.goto(address + "/life")
        expect(page.locator("#task-title")).to_have_text("Task 0")


def test_the_routes_refuse_what_is_not_there(where: Path):
    walk_lattice(where, 1)
    with TestClient(app_with_pages(ServiceSettings(str(where))), base_url="http://127.0.0.1") as client:
        assert client.get("/v1/lives").json()["lives"][0]["tasks"] == 1
        with open_memory(where) as memory:
            assert client.get("/v1/lives/revision").json() == {"revision": memory.revision()}
        assert client.get("/v1/lives/map?world=elsewhere").json() == {"map": None}
        for path, status, message in (
            ("tasks?robot=ada&domain=moon", 404, "no task of 'moon'"),
            ("task?robot=ada&domain=lattice&number=7", 404, "no task 7"),
            ("task?robot=ada&domain=lattice&number=-1", 422, "number"),
            ("family?domain=moon", 404, "domain must be one of"),
            ("tasks?robot=&domain=lattice", 422, "robot"),
        ):
            answer = client.get(f"/v1/lives/{path}")
            assert answer.status_code == status, answer.text
            assert message in answer.json()["error"]["message"]
