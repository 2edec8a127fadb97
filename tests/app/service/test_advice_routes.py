"""Advice over HTTP: as the session in this process, each step once, also after a restart."""

import json

import numpy as np
import pytest

from lifelore.agent.advise.advise import AdviseSettings, advise
from lifelore.core.planning.planning import optimal_q
from lifelore.domains.advice.advice_maze import errand, maze_goals
from lifelore.domains.worlds import make_world

MAZE = "advice:3"


def expert_steps(world, goals, walks=4):
    """Optimal walks to each goal, each ended by a step without action."""
    random, steps = np.random.default_rng(0), []
    for goal in goals:
        tables = errand(world, int(goal)).tables()
        best = optimal_q(tables, world.discount).argmax(axis=1)
        for start in random.choice(tables.starts, walks):
            state = int(start)
            while state != goal:
                steps.append({"agent": int(goal), "state": state, "action": int(best[state])})
                state = int(tables.next_state[state, best[state], 0])
            steps.append({"agent": int(goal), "state": state, "action": None})
    return steps


@pytest.fixture(scope="module")
def maze():
    return make_world("advice", seed=3)


@pytest.fixture(scope="module")
def experts(maze):
    return expert_steps(maze, maze_goals(maze))


@pytest.fixture(scope="module")
def wandering(maze, experts):
    """Four hundred steps of an agent that tries moves at random, from where an expert began."""
    random, state, steps = np.random.default_rng(1), experts[0]["state"], []
    for _ in range(400):
        action = int(random.integers(4))
        steps.append({"state": state, "action": action})
        after = int(maze.neighbour[state, action])
        state = state if after < 0 else after
    return steps


def post(client, step, steps, agent="ada"):
    return client.post(f"/v1/advice/hall/agents/{agent}/steps", json={"step": step, "steps": steps})


def test_advice_is_that_of_the_session_also_after_a_restart(serve, where, experts, wandering, tmp_path):
    client = serve(where)
    put = client.put("/v1/advice/hall", json={"world": MAZE, "experts": experts})
    assert put.status_code == 200, put.text
    (tmp_path / "experts").write_text("".join(json.dumps(step) + "\n" for step in experts))
    lines = [json.dumps({"agent": "ada", **step}) for step in wandering]
    own = list(advise(lines, AdviseSettings(MAZE, str(tmp_path / "experts"))))
    assert any(one["advise"] for one in own)
    assert post(client, 0, wandering[:360]).json() == own[359] | {"step": 360, "taken": True}
    for number in range(360, 380):
        answer = post(client, number, [wandering[number]]).json()
        assert answer == own[number] | {"step": number + 1, "taken": True}
    again = serve(where)
    repeated = post(again, 379, [wandering[379]]).json()
    assert repeated == own[379] | {"step": 380, "taken": False}
    assert post(again, 380, wandering[380:]).json() == own[-1] | {"step": 400, "taken": True}
    assert "step must be 400" in post(again, 500, wandering[:1]).json()["error"]["message"]


def test_agents_of_a_desk_show_their_classes_also_after_a_restart(serve, where, experts, wandering, tmp_path):
    names, goals = ("staff", "visitor"), {step["agent"] for step in experts}
    by_class = [step | {"class": names[sorted(goals).index(step["agent"]) % 2]} for step in experts]
    (tmp_path / "experts").write_text("".join(json.dumps(step) + "\n" for step in by_class))
    desk = {"world": MAZE, "experts": by_class, "method": "classes"}
    client = serve(where)
    put = client.put("/v1/advice/hall", json=desk)
    assert put.status_code == 200, put.text
    assert put.json()["classes"] == list(names)
    # Ada shows nothing at first, then a badge, then another; the answers are those of the session.
    steps = [dict(step) for step in wandering]
    steps[100]["class"], steps[250]["class"] = "visitor", "staff"
    lines = [json.dumps({"agent": "ada", **step}) for step in steps]
    own = list(advise(lines, AdviseSettings(MAZE, str(tmp_path / "experts"), method="classes")))
    assert any(one["advise"] for one in own)
    assert post(client, 0, steps[:200]).json() == own[199] | {"step": 200, "taken": True}
    again = serve(where)
    assert post(again, 200, steps[200:]).json() == own[-1] | {"step": 400, "taken": True}
    unknown = post(again, 400, [wandering[0] | {"class": "cook"}])
    assert unknown.status_code == 422
    assert "class must be one of staff, visitor, or left out, got 'cook'" in unknown.json()["error"]["message"]
    missing = again.put("/v1/advice/other", json=desk | {"experts": experts})
    assert missing.status_code == 422
    assert missing.json()["error"]["message"].startswith("experts line 1: class must be a name such as staff")


def test_a_desk_without_classes_is_what_it_was(serve, where, experts, wandering):
    client = serve(where)
    client.put("/v1/advice/hall", json={"world": MAZE, "experts": experts})
    post(client, 0, wandering[:10])
    badges = [step | {"class": "staff"} for step in experts]
    assert client.put("/v1/advice/hall", json={"world": MAZE, "experts": badges}).json()["classes"] == []
    assert post(client, 10, wandering[10:11]).json()["step"] == 11, "the same desk again changes nothing"


def test_a_wrong_step_changes_nothing(serve, experts, wandering):
    client = serve()
    client.put("/v1/advice/hall", json={"world": MAZE, "experts": experts})
    for wrong in ({"state": 10**6, "action": 0}, {"state": 0, "action": "up"}, {"state": [-1, 0], "action": 0}):
        assert post(client, 0, [wandering[0], wrong]).status_code == 422
    assert post(client, 0, wandering[:1]).json()["step"] == 1


@pytest.mark.parametrize(
    "world",
    ["/etc/passwd", "../map.yaml", "map.yaml", "office.yml", "advice:3/..", "advice:-1", "nowhere", "file://x"],
)
def test_a_world_is_no_file(serve, experts, world):
    answer = serve().put("/v1/advice/hall", json={"world": world, "experts": experts})
    assert answer.status_code in (404, 422)
    assert "root:" not in answer.text


def test_a_served_map_has_a_name(serve, tmp_path):
    from PIL import Image

    Image.fromarray(np.full((40, 60), 254, np.uint8)).save(tmp_path / "hall.pgm")
    (tmp_path / "hall.yaml").write_text(
        "image: hall.pgm\nresolution: 0.25\norigin: [0, 0, 0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    client = serve(maps={"hall": str(tmp_path / "hall.yaml")})
    experts = [{"agent": 0, "state": state, "action": "east"} for state in range(3)]
    put = client.put("/v1/advice/hall", json={"world": "hall", "experts": experts, "cell": 1.0})
    assert put.status_code == 200, put.text
    assert put.json()["experts"] == 1
    assert (
        client.put("/v1/advice/hall", json={"world": "hall", "experts": experts, "cell": 1e-6}).status_code == 422
    )
    missing = client.put("/v1/advice/hall", json={"world": "attic", "experts": experts})
    assert str(tmp_path) not in missing.text
