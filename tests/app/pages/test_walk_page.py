"""The page `/walk` as a person uses it: lost, advised, at the goal, without advice, on a served map."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("fastapi", reason="needs the extra web")
pytest.importorskip("playwright", reason="needs the extra browser")

from fastapi.testclient import TestClient
from numpy.typing import NDArray
from playwright.sync_api import Browser, Page, Route, expect

from lifelore.agent.advise.advice_desk import AdviceDesk
from lifelore.agent.advise.walk_building import WalkBuilding, walk_building
from lifelore.app.pages.mount import app_with_pages
from lifelore.app.service.settings import ServiceSettings
from lifelore.app.service.tokens import add_token
from lifelore.core.learning.known_world import GOAL, goal_distances
from lifelore.domains.grids.grid_world import MOVE_NAMES
from lifelore.memory import open_memory

pytestmark = [pytest.mark.browser, pytest.mark.slow]

DESKTOP, PHONE = {"width": 1280, "height": 800}, {"width": 390, "height": 844}
MAZE = "advice:3"
OFFICE = Path(__file__).parents[3] / "examples" / "data" / "office.yaml"
KEYS = {"north": "ArrowUp", "south": "ArrowDown", "east": "ArrowRight", "west": "ArrowLeft"}


class Walker:
    """A person at the page, who knows the name of the walk from its address."""

    def __init__(self, page: Page) -> None:
        self.page, self.steps, self.walk = page, 0, ""
        page.on("request", self._note)

    def _note(self, request) -> None:
        found = re.search(r"/v1/walks/(walk-[0-9-]+)$", request.url)
        if found and request.method == "PUT":
            self.walk, self.steps = found.group(1), 0

    def ready(self) -> None:
        expect(self.page.locator("#errand")).to_have_text(re.compile(r"^Find the .* · 0 steps"), timeout=60_000)

    def begin(self, building: str) -> None:
        self.page.get_by_role("combobox", name="Building").select_option(building)
        self.page.get_by_role("button", name="New start").click()
        self.ready()

    def press(self, move: str) -> None:
        self.page.keyboard.press(KEYS[move])
        self.steps += 1
        expect(self.page.locator("#errand")).to_contain_text(f"· {self.steps} step")


def way(building: WalkBuilding, walk: str) -> list[str]:
    """Moves of a shortest way of a walk's errand."""
    start, place = building.errand(walk)
    return moves_down(building, start, building.distance[place])


def moves_down(building: WalkBuilding, state: int, distance: NDArray[np.int32]) -> list[str]:
    """Moves from a state to where the distance is 0."""
    moves = []
    while distance[state]:
        target = building.world.neighbour[state]
        left = np.where(target >= 0, distance[target], np.iinfo(np.int32).max)
        moves.append(MOVE_NAMES[int(np.argmin(left))])
        state = int(target[np.argmin(left)])
    return moves


def same_errand(page: Page) -> None:
    """Let all walks of the page, which is not open yet, have one name, whose start is beside a wall."""
    page.add_init_script("crypto.getRandomValues = (numbers) => numbers.fill(8)")


def closed_move(page: Page) -> str:
    words = page.locator("#seen").inner_text().split(".")[0]
    return next(move for move in MOVE_NAMES if move not in words)


def test_a_person_gets_lost_is_advised_and_finds_the_place(
    serve_pages: Callable[..., str], open_page: Callable[..., Page], tmp_path: Path
):
    page = open_page(address := serve_pages())
    same_errand(page)
    page.goto(address + "/walk")
    walker = Walker(page)
    walker.begin(MAZE)
    expect(page.locator("#map")).to_be_focused()
    expect(page.locator("#map")).to_have_attribute("role", "img")

    wall = closed_move(page)
    for _ in range(20):
        expect(page.locator("#counsel")).to_contain_text("No advice now")
        walker.press(wall)
    expect(page.locator("#counsel")).to_contain_text(re.compile(r"Advice: (north|south|east|west) \d+\s%"))
    advised = page.locator("#moves button.advised")
    shares = [int(re.sub(r"\D", "", text)) for text in advised.locator(".share").all_inner_texts()]
    assert sum(shares) == pytest.approx(100, abs=2)
    expect(page.locator("#curves")).to_have_attribute("aria-label", re.compile("Advice was shown at 1 of them"))
    expect(page.locator("#curves")).to_contain_text("threshold κ = 0.5")

    # A bump does not move the person, so the shortest way is still that from the start.
    building = walk_building(MAZE, {})
    moves = way(building, walker.walk)
    for move in moves:
        walker.press(move)
    words = f"in {20 + len(moves)} steps; the shortest way has {len(moves)}"
    expect(page.get_by_role("status").filter(has_text="You found")).to_contain_text(words)
    row = page.locator("#walks tbody tr").first.locator("td")
    expect(row).to_have_text(
        ["on", re.compile(r"\w+"), str(20 + len(moves)), str(len(moves)), f"{1 + 20 / len(moves):.1f}"]
    )
    expect(page.locator("#moves button").first).to_be_disabled()
    expect(page.locator("#start")).to_be_focused()

    # Every step on the page is in the memory.
    with open_memory(tmp_path / "pages.db") as memory:
        desk = AdviceDesk(memory, f"walk {MAZE}", {})
        state = int(building.places[building.errand(walker.walk)[1]])
        answer = desk.answer(walker.walk, 0, [{"state": state, "action": None}])
    assert answer["step"] == walker.steps + 1


def test_the_page_says_where_no_expert_has_been(serve_pages: Callable[..., str], open_page: Callable[..., Page]):
    page = open_page(serve_pages() + "/walk")
    walker = Walker(page)
    walker.begin(MAZE)
    building = walk_building(MAZE, {})
    passed = {step["state"] for step in building.expert_steps}
    unknown = np.array([0 if s in passed else GOAL for s in range(building.world.n_states)], np.int8)
    start, _ = building.errand(walker.walk)
    moves = moves_down(building, start, goal_distances(building.world.neighbour, unknown))
    assert moves
    for move in moves:
        expect(page.locator("#counsel")).not_to_contain_text("No expert")
        walker.press(move)
    expect(page.locator("#counsel")).to_contain_text("No expert's walk leads on from here")


def painted(page: Page) -> bytes:
    """The bytes of the map and the curves as they are drawn."""
    return page.evaluate(
        "document.getElementById('map').toDataURL() + document.getElementById('curves').innerHTML"
    )


@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_a_reload_goes_on_with_the_walk_in_progress(
    serve_pages: Callable[..., str], open_page: Callable[..., Page], size: dict[str, int]
):
    page = open_page(serve_pages() + "/walk", size)
    walker = Walker(page)
    page.get_by_label("Advice when I seem lost").uncheck()
    walker.begin(MAZE)
    name, building = walker.walk, walk_building(MAZE, {})
    moves = way(building, name)
    for move in moves[:12]:
        walker.press(move)
    heading, before = page.locator("#errand").inner_text(), painted(page)
    for leave in (page.reload, lambda: page.goto(page.url.replace("walk", "life")) and page.go_back()):
        leave()
        expect(page.locator("#errand")).to_have_text(heading)
        assert painted(page) == before
        expect(page.get_by_role("combobox", name="Building")).to_have_value(MAZE)
        expect(page.get_by_label("Advice when I seem lost")).not_to_be_checked()
    # The answer to a step is lost: the service has the step, the page has not.
    page.evaluate(
        "() => { const own = window.fetch; window.fetch = async (...asked) => { await own(...asked); throw 0; }; }"
    )
    page.keyboard.press(KEYS[moves[12]])
    expect(page.get_by_role("alert")).to_contain_text("does not answer")
    page.reload()
    expect(page.locator("#errand")).to_contain_text("· 13 steps")
    walker.steps = 13
    for move in moves[13:]:
        walker.press(move)
    words = f"in {len(moves)} steps; the shortest way has {len(moves)}"
    expect(page.get_by_role("status").filter(has_text="You found")).to_contain_text(words)
    row = page.locator("#walks tbody tr").all_inner_texts()
    page.reload()
    expect(page.get_by_role("status").filter(has_text="You found")).to_contain_text(words)
    assert page.locator("#walks tbody tr").all_inner_texts() == row
    assert walker.walk == name
    walker.begin("advice:3")
    assert walker.walk != name


def test_a_walk_that_the_memory_has_lost_is_not_begun_again(
    serve_pages: Callable[..., str], browser: Browser, tmp_path: Path
):
    # Not by `open_page`: the browser itself logs each answer that is an error.
    with browser.new_context() as context:
        page = context.new_page()
        page.goto(serve_pages() + "/walk")
        walker = Walker(page)
        walker.begin(MAZE)
        name = walker.walk
        page.evaluate(
            "sessionStorage['lifelore walks'] = sessionStorage['lifelore walks'].replace(/walk-[0-9-]+/, 'walk-0')"
        )
        page.reload()
        expect(page.locator("#errand")).to_have_text("Choose a building and press New start")
        expect(page.get_by_role("alert")).to_have_count(0)
        walker.begin(MAZE)
        assert walker.walk not in (name, "walk-0")


def test_a_visit_stores_nothing(serve_pages: Callable[..., str], open_page: Callable[..., Page], tmp_path: Path):
    page = open_page(serve_pages() + "/walk")
    expect(page.locator("#errand")).to_have_text("Choose a building and press New start")
    expect(page.get_by_role("combobox", name="Building")).not_to_have_value("")
    page.keyboard.press("ArrowUp")
    page.reload()
    with open_memory(tmp_path / "pages.db") as memory:
        assert memory.robots() == []


def test_two_tabs_of_one_walk_agree(serve_pages: Callable[..., str], open_page: Callable[..., Page]):
    page = open_page(serve_pages() + "/walk")
    walker = Walker(page)
    walker.begin(MAZE)
    twin = page.context.new_page()
    twin.goto(page.url.replace("/walk", "/life"))
    twin.evaluate(
        "(text) => sessionStorage.setItem('lifelore walks', text)",
        page.evaluate("sessionStorage['lifelore walks']"),
    )
    twin.goto(page.url)
    expect(twin.locator("#errand")).to_contain_text("· 0 steps")
    for move in way(walk_building(MAZE, {}), walker.walk)[:3]:
        walker.press(move)
    twin.keyboard.press("ArrowUp")
    expect(twin.locator("#errand")).to_contain_text("· 3 steps")
    assert painted(twin) == painted(page)


def test_without_advice_there_are_no_arrows_and_the_curve_goes_on(
    serve_pages: Callable[..., str], open_page: Callable[..., Page]
):
    page = open_page(address := serve_pages(), PHONE)
    same_errand(page)
    page.goto(address + "/walk")
    walker = Walker(page)
    page.get_by_label("Advice when I seem lost").uncheck()
    walker.begin(MAZE)
    expect(page.locator("#counsel")).to_contain_text("Advice is off. P(M | H) 0.20")
    wall = closed_move(page)
    for _ in range(24):
        page.locator(f"#moves button[data-move={wall}]").click()
        walker.steps += 1
        expect(page.locator("#errand")).to_contain_text(f"· {walker.steps} step")
    expect(page.locator("#counsel")).to_contain_text("Advice is off. P(M | H) 0.00")
    expect(page.locator("#moves button.advised")).to_have_count(0)


def test_a_map_of_the_person_comes_first(serve_pages: Callable[..., str], open_page: Callable[..., Page]):
    page = open_page(serve_pages("--map", f"hall={OFFICE}") + "/walk")
    walker = Walker(page)
    expect(page.get_by_role("combobox", name="Building")).to_have_value("hall")
    walker.begin("hall")
    walker.press("north")
    # Arrow keys in the list of buildings choose a building and are no step.
    page.get_by_role("combobox", name="Building").focus()
    page.keyboard.press("ArrowDown")
    expect(page.get_by_role("combobox", name="Building")).to_have_value("building:0")
    expect(page.locator("#errand")).to_contain_text("· 1 step ")
    page.keyboard.press("Tab")
    walker.press("south")
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    walker.ready()


def test_an_error_of_the_service_is_a_line_on_the_page(serve_pages: Callable[..., str], browser: Browser):
    # Not by `open_page`, which takes a refused request for a defect. Interception begins before the page is
    # open: Chromium does not promise that a later one reaches the page before the next key does.
    disk_full = True

    def answer(route: Route) -> None:
        if disk_full:
            route.fulfill(status=503, json={"error": {"message": "the disk is full"}})
        else:
            route.continue_()

    page = browser.new_page()
    page.route("**/steps", answer)
    page.goto(serve_pages() + "/walk")
    walker = Walker(page)
    walker.begin(MAZE)
    page.keyboard.press("ArrowUp")
    expect(page.get_by_role("alert")).to_have_text("the disk is full")
    expect(page.locator("#errand")).to_contain_text("· 0 steps")
    disk_full = False
    walker.press("north")
    expect(page.get_by_role("alert")).to_have_count(0)
    page.close()


def test_routes_check_what_they_are_given(tmp_path: Path):
    settings = ServiceSettings(str(tmp_path / "m.db"))
    with TestClient(app_with_pages(settings), base_url="http://127.0.0.1") as client:
        assert client.get("/v1/walks/ada", params={"building": MAZE}).status_code == 404
        assert client.get("/v1/memory").json()["robots"] == []
        begun = client.put("/v1/walks/ada", json={"building": MAZE}).json()
        step = {"building": MAZE, "step": 1, "state": begun["state"], "move": "north"}
        assert client.post("/v1/walks/ada/steps", json=step).json()["step"] == 1
        for wrong in ({"step": 5}, {"state": 10**6}, {"move": "up"}, {"step": 0}, {"extra": 1}):
            answer = client.post("/v1/walks/ada/steps", json=step | wrong)
            assert answer.status_code == 422, wrong
            assert answer.json()["error"]["message"]
        for name in ("../map.yaml", "/etc/passwd", "attic", "advice:3/..", "building:77"):
            answer = client.put("/v1/walks/ben", json={"building": name})
            assert answer.status_code == 404
            assert answer.json()["error"]["message"].startswith("building must be one of")
            assert client.get("/v1/walks/ada", params={"building": name}).status_code == 404
        assert client.get("/v1/walks/ada", params={"building": MAZE}).json()["step"] == 1
        assert client.get("/v1/walks/ada", params={"building": MAZE, "advice": False}).status_code == 404
        assert client.get("/v1/walks/ben", params={"building": MAZE}).status_code == 404
        assert client.get("/v1/walks/ada", params={"building": MAZE, "extra": 1}).status_code == 422
        assert client.put("/v1/walks/ada", json={"building": MAZE}).status_code == 422


def test_routes_answer_as_documented(tmp_path: Path):
    schemathesis = pytest.importorskip("schemathesis", reason="needs the extra test")
    from hypothesis import HealthCheck, given, settings
    from schemathesis.specs.openapi.checks import positive_data_acceptance

    # With a token file, requests for any host name pass.
    token = add_token(str(tmp_path / "tokens"), "schemathesis", ["read", "write"])
    app = app_with_pages(ServiceSettings(str(tmp_path / "m.db"), token_file=str(tmp_path / "tokens"), rate=0.0))
    with TestClient(app):
        routes = schemathesis.openapi.from_asgi("/openapi.json", app).include(path_regex="^/v1/walks")
        found = list(routes.get_all_operations())
        assert len(found) == 4
        for operation in found:

            @given(case=operation.ok().as_strategy())
            @settings(
                max_examples=15, derandomize=True, database=None,
                suppress_health_check=list(HealthCheck),  # pyright: ignore[reportArgumentType]
            )  # fmt: skip
            def answers(case):
                case.call_and_validate(
                    headers={"Authorization": f"Bearer {token}"}, excluded_checks=[positive_data_acceptance]
                )

            answers()
