"""The verb `advise`: lines in, advice out; and what it makes of experts' files."""

import json
from dataclasses import replace

import numpy as np
import pytest

from lifelore.agent.advise.advise import AdviceSession, AdviseSettings, advise, world_of
from lifelore.agent.advise.expert_trajectories import goal_models, goals_of_ends, state_after, trajectories
from lifelore.agent.advise.step_lines import NO_ACTION, StepLine, read_steps
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.planning.planning import optimal_q
from lifelore.domains.advice.advice_maze import errand, maze_goals
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.worlds import make_world

NORTH, SOUTH, EAST, WEST = range(4)
ROW = GridWorld.from_free("row", np.ones((1, 12), bool))
"""Twelve places from west to east."""
MAZE = "advice:3"


def line(agent, state, action) -> str:
    return json.dumps({"agent": agent, "state": state, "action": action})


def expert_lines(world, goals, walks=6):
    """Optimal walks to each goal, each ended by a line without action."""
    random, lines = np.random.default_rng(0), []
    for goal in goals:
        tables = errand(world, int(goal)).tables()
        best = optimal_q(tables, world.discount).argmax(axis=1)
        for start in random.choice(tables.starts, walks):
            state = int(start)
            while state != goal:
                lines.append(line(f"expert of {goal}", state, int(best[state])))
                state = int(tables.next_state[state, best[state], 0])
            lines.append(line(f"expert of {goal}", state, None))
    return lines


@pytest.fixture(scope="module")
def maze():
    return make_world("advice", seed=3)


@pytest.fixture(scope="module")
def experts(maze, tmp_path_factory):
    path = tmp_path_factory.mktemp("experts") / "experts.jsonl"
    path.write_text("\n".join(expert_lines(maze, maze_goals(maze))) + "\n")
    return str(path)


# ---- lines -----------------------------------------------------------------------------------------


def test_states_and_actions_by_number_cell_or_name():
    lines = [line("a", 3, 2), "", line(7, [0, 4], "west"), line("a", 5, None)]
    assert list(read_steps(lines, ROW, "x")) == [
        ("a", 3, EAST, None),
        (7, 4, WEST, None),
        ("a", 5, NO_ACTION, None),
    ]


@pytest.mark.parametrize(
    ("bad", "words"),
    [
        ("{", "not JSON"),
        ("[1, 2]", "must be an object"),
        ('{"state": 1, "action": 0}', "agent must be a name or a number, got None"),
        (line("a", 12, 0), r"state must be a number in \[0, 12\) or a free cell"),
        (line("a", True, 0), "state must be"),
        (line("a", [0, 12], 0), r"got \[0, 12\]"),
        (line("a", 1, 4), "action must be 0 to 3, north, south, east, west, or null, got 4"),
        (line("a", 1, "up"), "got 'up'"),
        ('{"agent": "a", "state": 1}', "action must be"),
    ],
)
def test_a_bad_line_is_named_by_file_and_number(bad, words):
    with pytest.raises(InputError, match=f"^steps.jsonl line 3: .*{words}"):
        list(read_steps([line("a", 1, 0), "", bad], ROW, "steps.jsonl"))


# ---- experts ---------------------------------------------------------------------------------------


def test_where_a_step_leads():
    assert [state_after(ROW, StepLine("a", 3, a)) for a in (EAST, WEST, NORTH, NO_ACTION)] == [4, 2, 3, 3]


def test_walks_end_at_a_line_without_action_and_where_the_next_begins_elsewhere():
    steps = [
        *(("a", 0, EAST), ("b", 9, WEST), ("a", 1, NORTH), ("a", 1, EAST), ("a", 2, NO_ACTION)),
        *(("a", 2, EAST), ("b", 5, EAST), ("b", 6, EAST), ("c", 4, NO_ACTION)),
    ]
    found = trajectories([StepLine(*step) for step in steps], ROW)
    walks = sorted((walk.states.tolist(), walk.actions.tolist()) for walk in found)
    assert walks == [
        ([0, 1, 1, 2], [EAST, NORTH, EAST]),
        ([2, 3], [EAST]),
        ([5, 6, 7], [EAST, EAST]),
        ([9, 8], [WEST]),
    ]


def test_ends_near_one_another_are_one_goal_the_commonest_of_them():
    # 0 and 2 are joined, 4 joins by 2; 8 and 9 are another place, 9 the commoner.
    ends = [0, 2, 2, 4, 8, 9, 9]
    walks = trajectories([StepLine(i, end, NORTH) for i, end in enumerate(ends)], ROW)
    assert goals_of_ends(walks, ROW) == [2, 9]


def test_walks_belong_to_goals_within_two_moves():
    walks = trajectories([StepLine(i, end, NORTH) for i, end in enumerate([0, 2, 7])], ROW)
    (near,) = goal_models(walks, [1, 11], ROW)
    assert near.goals == (1,)
    assert np.flatnonzero(np.isfinite(near.steps)).tolist() == [0, 2]
    with pytest.raises(InputError, match="experts must end at one of the 1 goals at least once, got none of 3"):
        goal_models(walks, [11], ROW)


def test_the_goals_of_the_maze_are_found_from_where_experts_ended(maze, experts):
    desk = AdviceSession(AdviseSettings(MAZE, experts))
    assert desk.goals == sorted(maze_goals(maze).tolist())
    assert desk.n_experts == 48


# ---- advice ----------------------------------------------------------------------------------------


def walk_of_a_lost_agent(desk, goal, seed, obey, max_steps=5000):
    """Uniformly random moves, or as told: (reached, advised, steps)."""
    random, world = np.random.default_rng(seed), desk.world
    state, advised, answer = int(random.choice(world.n_states)), 0, None
    answer = desk.answer(StepLine(seed, state, NO_ACTION))
    for t in range(max_steps):
        told = answer["advise"] and obey
        action = int(random.choice(4, p=answer["theta"] if told else None))
        advised += told
        step = StepLine(seed, state, action)
        state = state_after(world, step)
        if state == goal:
            return True, advised, t + 1
        answer = desk.answer(step)
    return False, advised, max_steps


@pytest.mark.slow
def test_lost_agents_find_the_goal_they_never_told(maze, experts):
    goals = maze_goals(maze).tolist()
    better = AdviceSession(AdviseSettings(MAZE, experts))
    told = [walk_of_a_lost_agent(better, goals[i], i, obey=True) for i in range(8)]
    alone = [walk_of_a_lost_agent(better, goals[i], i + 100, obey=False) for i in range(8)]
    assert sum(reached for reached, *_ in told) >= 7
    assert sum(reached for reached, *_ in alone) <= 4
    assert all(advised <= 0.4 * steps for _, advised, steps in told)


def test_answers_have_the_promised_form(maze, experts):
    start = int(maze_goals(maze)[0])
    steps = [line("x", start, None), line("y", start, None), line("x", start, "north")]
    for method in ("better", "thesis"):
        answers = list(advise(steps, AdviseSettings(MAZE, experts, method=method)))
        assert [answer["agent"] for answer in answers] == ["x", "y", "x"]
        for answer in json.loads(json.dumps(answers, allow_nan=False)):
            assert list(answer) == ["agent", "advise", "theta", "p_normal", "gain"]
            assert isinstance(answer["advise"], bool)
            assert answer["theta"] is None or sum(answer["theta"]) == pytest.approx(1)
            assert 0 <= answer["p_normal"] <= 1
            assert answer["gain"] >= 0


def steps_by_class():
    """Staff walk east and visitors west, all from the middle."""

    def expert(agent, of_class, action, states):
        return [{"agent": agent, "class": of_class, "state": state, "action": action} for state in states]

    return [*expert("s", "staff", EAST, range(2, 9)), *expert("v", "visitor", WEST, range(8, 1, -1))]


def test_each_agent_shows_its_own_class(tmp_path):
    path = tmp_path / "experts.jsonl"
    path.write_text("".join(json.dumps(step) + "\n" for step in steps_by_class()))
    settings = AdviseSettings("lattice", str(path), method="classes", kappa=9.0)

    def shown(agent, of_class):
        return json.dumps({"agent": agent, "state": 5, "action": None, "class": of_class})

    lines = [
        shown("a", "staff"),
        shown("b", "visitor"),
        line("c", 5, None),
        line("a", 5, None),
        shown("c", "staff"),
    ]
    answers = list(advise(lines, settings))
    staff = [one["classes"]["staff"] for one in answers]
    assert staff == pytest.approx([0.99, 0.01, 0.5, 0.99, 0.99]), "a class holds until another is shown"
    # Steps count on when an agent shows its class later, and shown classes win over that of all agents.
    late = list(advise([line("a", 5, WEST), shown("a", "staff")], settings))[-1]["classes"]["visitor"]
    inferred = next(iter(advise([line("a", 5, WEST)], settings)))["classes"]["visitor"]
    assert late / (1 - late) == pytest.approx(inferred / (1 - inferred) * 0.01 / 0.99)
    everyone = replace(settings, shown="visitor")
    assert [one["classes"]["staff"] for one in advise(lines[1:4], everyone)] == pytest.approx([0.01] * 3)
    assert next(iter(advise(lines[:1], everyone)))["classes"]["staff"] == pytest.approx(0.99)
    with pytest.raises(
        InputError, match="input line 1: class must be one of staff, visitor, or left out, got 'cook'"
    ):
        list(advise([shown("a", "cook")], settings))
    other = replace(settings, method="better")
    assert "classes" not in next(iter(advise([shown("a", "cook")], other))), (
        "classes are not read by other methods"
    )


def test_classes_have_priors_of_their_own(tmp_path):
    steps = steps_by_class()
    path = tmp_path / "experts.jsonl"
    path.write_text("".join(json.dumps(step) + "\n" for step in steps))
    settings = AdviseSettings("lattice", str(path), method="classes", kappa=9.0)  # never advised
    first, second = advise([line("x", 5, None), line("x", 5, WEST)], settings)
    assert list(first) == ["agent", "advise", "theta", "p_normal", "gain", "classes"]
    assert first["classes"] == {"staff": 0.5, "visitor": 0.5}
    # Of one expert and pseudo-counts of 0.1, with 5 % of every model spread over four moves.
    west = {name: 0.95 * count / 1.4 + 0.0125 for name, count in (("staff", 0.1), ("visitor", 1.1))}
    assert second["classes"]["visitor"] == pytest.approx(west["visitor"] / sum(west.values()))
    tagged = next(iter(advise([line("x", 5, None)], replace(settings, shown="staff"))))
    assert tagged["classes"]["staff"] == pytest.approx(0.99)
    assert tagged["theta"] == np.eye(4)[EAST].tolist()
    with pytest.raises(NotFoundError, match="shown must be a class of the experts, staff, visitor, got 'nurse'"):
        AdviceSession(replace(settings, shown="nurse"))
    with pytest.raises(InputError, match="shown applies to method classes, got 'staff' for better"):
        AdviseSettings("lattice", str(path), shown="staff")
    assert second["theta"] == np.eye(4)[WEST].tolist()
    path.write_text(json.dumps({"agent": "s", "state": 2, "action": EAST}) + "\n")
    with pytest.raises(InputError, match=r"experts.jsonl line 1: class must be a name such as staff, got None"):
        AdviceSession(settings)
    path.write_text("".join(json.dumps(steps[i] | {"agent": "s"}) + "\n" for i in (0, -1)))
    with pytest.raises(InputError, match="line 2: agent 's' must have one class, got 'visitor' after 'staff'"):
        AdviceSession(settings)


def test_agents_are_told_apart(maze, experts):
    # What x does moves nothing of what y is told.
    start = int(maze_goals(maze)[0])
    wander = [line("x", start, a % 4) for a in range(40)]
    alone = list(advise([line("y", start, None)], AdviseSettings(MAZE, experts)))
    beside = list(advise([*wander, line("y", start, None)], AdviseSettings(MAZE, experts)))
    assert beside[-1] == alone[0]


def test_goals_from_a_file(maze, experts, tmp_path):
    wanted = maze_goals(maze)[:2].tolist()
    (tmp_path / "goals.jsonl").write_text("".join(json.dumps({"state": goal}) + "\n" for goal in wanted))
    desk = AdviceSession(AdviseSettings(MAZE, experts, str(tmp_path / "goals.jsonl")))
    assert desk.goals == sorted(wanted)
    (tmp_path / "goals.jsonl").write_text('{"state": 0}\n{"state": -1}\n')
    with pytest.raises(InputError, match=r"goals.jsonl line 2: state must be"):
        AdviceSession(AdviseSettings(MAZE, experts, str(tmp_path / "goals.jsonl")))
    (tmp_path / "goals.jsonl").write_text("\n")
    with pytest.raises(InputError, match="must name at least one goal"):
        AdviceSession(AdviseSettings(MAZE, experts, str(tmp_path / "goals.jsonl")))


def test_worlds_by_name_and_seed_or_by_map(tmp_path):
    assert world_of(AdviseSettings("noise:4", "x")).fingerprint == make_world("noise", seed=4).fingerprint
    assert world_of(AdviseSettings("lattice", "x")).name == "lattice"
    assert world_of(AdviseSettings("building:1", "x")).fingerprint == make_world("building", seed=1).fingerprint
    with pytest.raises(InputError, match="NAME:SEED with a whole number, got 'advice:x'"):
        world_of(AdviseSettings("advice:x", "x"))
    with pytest.raises(NotFoundError, match="world must be a map's YAML or one of building"):
        world_of(AdviseSettings("moon", "x"))


def test_mistakes_are_one_clear_line(experts, tmp_path):
    with pytest.raises(NotFoundError, match="method must be one of better, thesis, classes, got 'best'"):
        AdviseSettings(MAZE, experts, method="best")
    with pytest.raises(NotFoundError, match="file 'none' does not exist"):
        AdviceSession(AdviseSettings(MAZE, "none"))
    (tmp_path / "empty.jsonl").write_text(line("a", 1, None))
    with pytest.raises(InputError, match="must hold at least one step with an action"):
        AdviceSession(AdviseSettings(MAZE, str(tmp_path / "empty.jsonl")))
    (tmp_path / "bytes.jsonl").write_bytes(b"\xff\xfe\n")
    with pytest.raises(InputError, match="must be JSON lines in UTF-8"):
        AdviceSession(AdviseSettings(MAZE, str(tmp_path / "bytes.jsonl")))
    for share in (0.0, 1.5):
        with pytest.raises(InputError, match="share must be a share"):
            AdviceSession(AdviseSettings(MAZE, experts, share=share))
