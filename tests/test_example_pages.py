"""The pages of `examples/pages`, asked as their scripts ask: a program plays, assembles and walks for a person."""

import shlex
import sys
from collections import deque
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("starlette", reason="needs the extra web")

from starlette.testclient import TestClient

from examples.pages.play import serve as play
from examples.pages.teach import serve as teach
from examples.pages.teach.lesson import SELF, SHOWN, WITHOUT, Lesson
from examples.pages.walk import serve as walk
from examples.pages.walk.building import PLACE_NAMES, Building, Walk
from lifelore.action.demonstrations.demonstrations import read_demonstrations
from lifelore.core.errors import InputError
from lifelore.domains.ball_game.ball_game import SIZES, ball_game
from lifelore.domains.ball_game.simulated_player import choose_heading
from lifelore.domains.grids.grid_world import MOVE_NAMES
from reproduction.chapter4.c4_14_people.records import recorded_sessions
from reproduction.chapter4.c4_14_people.study_plan import StudySettings

ROOT = Path(__file__).parents[1]
FIELD = ball_game().field


def client_of(app) -> TestClient:
    client = TestClient(app, base_url="http://127.0.0.1")
    page = client.get("/").text
    for part in [piece.split('"')[0] for piece in page.split('src="')[1:]]:
        assert client.get(part).status_code == 200
    return client


@pytest.mark.parametrize("serve", [play, teach, walk], ids=lambda module: module.__name__)
def test_the_guide_names_the_command_that_serves_a_page(serve, monkeypatch):
    started = []
    monkeypatch.setattr(serve, "serve", lambda app, port: started.append(port))
    command = f"python -m {serve.__name__} "
    (line,) = [one for one in (ROOT / "docs" / "pages.md").read_text("utf-8").splitlines() if command in one]
    monkeypatch.setattr(sys, "argv", shlex.split(line, comments=True)[2:])
    serve.main()
    assert len(started) == 1


def test_a_script_plays_a_session_and_the_file_has_its_rounds(tmp_path):
    settings = StudySettings("scripted", sizes=(2, 60), speeds=(30, 70), practice=0, test=1)
    client = client_of(play.study_app(str(tmp_path / "rounds.jsonl"), settings))
    ask = lambda path, **body: client.post(path, json=body)  # noqa: E731
    assert "agree to the text first" in ask("/begin").json()["error"]["message"]
    assert ask("/take_part", consent="yes").status_code == 422
    assert not (tmp_path / "rounds.jsonl").exists()
    view = ask("/take_part", consent=True).json()
    while view["next"]:
        ball = ask("/begin").json()
        kind = SIZES.index(view["next"]["size"])
        while not ball["over"]:
            ball = ask("/move", heading=int(choose_heading(FIELD, kind, ball["x"], ball["y"], 50))).json()
        assert ball["reached"]
        view = ball["session"]
    (session,) = recorded_sessions(tmp_path / "rounds.jsonl")
    assert session.finished
    assert session.settings == settings
    assert client.get("/game").json()["session"] == view
    assert client.get("/game", headers={"host": "elsewhere.example"}).status_code == 400
    assert {StudySettings(**one).rounds for one in play.LENGTHS.values()} == {16, 44, 92}


def show_best(lesson: Lesson) -> None:
    while not lesson.over:
        lesson.act(int(lesson.present.best[lesson.state].argmax()))


def test_a_lesson_by_the_page_is_written_and_its_prior_advises(tmp_path):
    client = client_of(teach.lesson_app(str(tmp_path / "d.jsonl"), 1, 0))
    twin, view = Lesson(1), client.get("/lesson").json()
    assert not view["advised"]
    while not view["over"]:
        action = int(twin.present.best[twin.state].argmax())
        twin.act(action)
        view = client.post("/step", json={"action": action}).json()
        assert view == twin.view()
    # -2 for each move, 10 for each of 2 uses, and 100 at the end.
    (shown,) = read_demonstrations(tmp_path / "d.jsonl")
    assert view["reward"] == -2 * int((shown.actions < 4).sum()) + 10 * 2 + 100
    assert len(shown.actions) == view["steps"]
    refused = client.post("/step", json={"action": 0})
    assert "go on to the next task" in refused.json()["error"]["message"]
    assert client.post("/go_on", content="{}").status_code == 422  # as another site could send it from a form
    view = client.post("/go_on", json={}).json()
    assert (view["number"], view["steps"], view["shown"]) == (1, 0, 1)


@pytest.mark.parametrize("action", [-1, 6, True, "procure", None, 1.0])
def test_a_wrong_action_changes_nothing(action):
    lesson = Lesson(1)
    with pytest.raises(InputError, match="action"):
        lesson.act(action)
    assert lesson.view()["steps"] == 0


def test_the_prior_of_an_expert_helps_learners_in_new_factories():
    lesson = Lesson(1)
    assert list(lesson.curves()) == [WITHOUT]
    for _ in range(5):
        show_best(lesson)
        lesson.go_on()
    curves = lesson.curves()
    # Eight factories, fixed seeds: the first ten episodes earn more with the prior in the mean.
    without, taught, exact = (np.mean(curves[name]["mean"][:10]) for name in (WITHOUT, SHOWN, SELF))
    assert without < 0.8 * taught < 0
    assert taught < exact


@pytest.fixture(scope="module")
def maze() -> Building:
    return Building("advice:3")


def test_places_are_far_apart_and_distances_are_shortest(maze):
    goal = int(maze.places[3])
    moves, frontier = {goal: 0}, deque([goal])
    while frontier:
        state = frontier.popleft()
        for beside in maze.world.neighbour[state].tolist():
            if beside >= 0 and beside not in moves:
                moves[beside] = moves[state] + 1
                frontier.append(beside)
    assert maze.distance[3].tolist() == [moves[state] for state in range(maze.world.n_states)]
    assert len(set(maze.places.tolist())) == len(PLACE_NAMES)


def test_a_walk_by_the_page(maze):
    client = client_of(walk.walk_app(maze))
    view = client.get("/walk").json()
    closed = next(move for move in MOVE_NAMES if move not in view["open"])
    bumped = client.post("/step", json={"move": closed}).json()
    assert (bumped["steps"], bumped["at"]) == (1, view["at"])
    assert client.post("/step", json={"move": "up"}).status_code == 422
    begun = client.post("/begin", json={"advice": False}).json()
    assert (begun["steps"], begun["advise"]) == (0, False)
    row, column = begun["at"]
    assert all(np.hypot(r - row, c - column) <= 6 for r, c, _ in begun["seen"])
    assert begun["goal"] not in [place["name"] for place in begun["places"]]


@pytest.mark.parametrize("seed", range(10))
def test_every_errand_begins_where_a_lost_person_gets_advice(maze, seed):
    assert Walk(maze, True, seed).view()["theta"] is not None


def test_advice_comes_after_twenty_steps_of_who_seems_lost(maze):
    walks = [Walk(maze, advice, 1) for advice in (True, False)]
    closed = next(move for move in MOVE_NAMES if move not in walks[0].view()["open"])
    for one in walks:
        advised = []
        for _ in range(40):
            one.step(closed)
            advised.append(one.view()["advise"])
        # 0.75 steps are saved each step, first at the beginning: 15 are saved after 19 moves.
        assert advised == [step >= 20 and one is walks[0] for step in range(1, 41)]
    # Without advice all steps are evidence; with it, the person's own ones.
    assert walks[1].view()["p_normal"] < walks[0].view()["p_normal"]
