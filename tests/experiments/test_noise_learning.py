"""Learners in noise mazes: percepts, places and priors against slow twins, streams shared where they must be."""

import json

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.streams import stream
from lifelore.domains.grids.lattice import lattice
from lifelore.domains.grids.noise_maze import noise_maze
from lifelore.experiments.chapter3.c3_03_noise_maze_prior.run import (
    COMPARED,
    KEYS,
    METHODS,
    PERCEPT,
    PLACE,
    PLAIN,
    exact_prior,
    hows,
    rows_of,
    run_cell,
    run_of,
)
from lifelore.experiments.chapter3.lattice_learning import learn_task, schedule_of
from lifelore.experiments.engine.registry import claim_of

FULL = dict(claim_of("C3.3").sizes["full"])
QUICK = dict(claim_of("C3.3").sizes["quick"])

SMALL = {**QUICK, "episodes": 30, "test_tasks": 2, "training_tasks": [2, 4], "last": 5}
SMALL["default"] = {**QUICK["default"], "training_tasks": 4}
SCHEDULE = [1.0, 0.98, 0.01]


@pytest.fixture(scope="module")
def run():
    return run_of(SMALL, 3, 0)


def maze_of(names):
    """The maze of a task from its stream's names, drawn as `run_of` says: density, then maze, then goal."""
    random = stream(*names, "maze")
    density = random.uniform(0.5, 0.8)
    world = noise_maze(random, 11, density)
    return density, world, int(random.integers(world.n_states))


def test_every_task_has_a_maze_of_its_own_between_50_and_80_percent(run):
    mazes = [maze_of((3, "C3.3", 0, kind, i)) for kind, n in (("training", 4), ("testing", 2)) for i in range(n)]
    met = run.training["noise"] + run.testing
    for (density, world, goal), task in zip(mazes, met, strict=True):
        assert round(density * 81) == 81 - world.n_states
        assert (goal, world.n_states) == (task.problem.goal, task.problem.tables.n_states)
    assert len({world.fingerprint for _, world, _ in mazes}) == 6


def test_codes_by_a_slow_look_around(run):
    task = run.testing[1]
    _, world, _ = maze_of(task.problem.stream)
    for state, (row, column) in enumerate(world.cells.tolist()):
        assert task.contexts[PLACE][state] == 11 * row + column
        sides = [(-1, 0), (1, 0), (0, 1), (0, -1)]
        corners = [(-1, 1), (-1, -1), (1, 1), (1, -1)]
        free = [world.state_of[row + i, column + j] >= 0 for i, j in sides]
        full = [world.state_of[row + i, column + j] < 0 for i, j in corners]
        assert task.contexts[PERCEPT][state] == sum(bit << k for k, bit in enumerate(free + full))


@pytest.mark.parametrize("kind", [PLACE, PERCEPT])
def test_counts_by_a_slow_tally(run, kind):
    tally = {}
    for task in run.training["noise"]:
        for state, best in enumerate(task.problem.best):
            if state != task.problem.goal:
                row = tally.setdefault(int(task.contexts[kind][state]), np.zeros(4))
                row += best
    prior = exact_prior(run.training["noise"], kind, 0.1)
    assert prior.contexts.tolist() == sorted(tally)
    np.testing.assert_array_equal(prior.counts(sorted(tally)), [tally[code] for code in sorted(tally)])


def test_the_lattices_places_are_read_in_a_maze_and_others_are_unknown(run):
    grid = lattice(11)
    prior = exact_prior(run.training["lattice"], PLACE, 0.1)
    assert prior.contexts.tolist() == sorted((11 * row + column) for row, column in grid.cells.tolist())
    task = run.testing[0]
    places = task.contexts[PLACE]
    in_lattice = ((places // 11) % 2 == 1) | ((places % 11) % 2 == 1)
    assert (prior.unseen(places) == ~in_lattice).all()
    explore = np.diff(rows_of(task, prior, PLACE, "proportion", "uniform").explore_cum, axis=1, prepend=0)
    strange = np.flatnonzero(~in_lattice[np.argsort(places)])
    np.testing.assert_allclose(explore[strange], 0.25)


def test_a_percept_never_counts_a_move_into_a_wall(run):
    prior = exact_prior(run.training["noise"], PERCEPT, 0.1)
    passable = (prior.contexts[:, None] >> np.arange(4)) & 1
    assert not prior.counts(prior.contexts)[passable == 0].any()


def test_a_prior_that_has_seen_nothing_is_q_learning(run):
    schedule = schedule_of({**SMALL, "max_steps": 100}, SCHEDULE)
    task = run.testing[0]
    plain, learner = learn_task(task.problem, None, schedule)
    for kind in (PLACE, PERCEPT):
        guided, other = learn_task(
            task.problem, rows_of(task, ActionPrior(4), kind, "proportion", "prior"), schedule
        )
        assert plain.tobytes() == guided.tobytes()
        assert learner.q.tobytes() == other.q.tobytes()


def test_more_tasks_leave_the_first_ones_alone(run):
    more = run_of({**SMALL, "training_tasks": [2, 5], "test_tasks": 3}, 3, 0)
    for kind in ("lattice", "noise"):
        goals = [task.problem.goal for task in run.training[kind]]
        assert [task.problem.goal for task in more.training[kind]][:4] == goals
    assert [task.problem.stream for task in more.testing][:2] == [task.problem.stream for task in run.testing]


def test_the_grid_of_full_by_counting():
    found = hows(FULL)
    # Under each of 3 schedules: (2 forms × 2 α⁰ + support) × 2 ties, one other cap, one other number of tasks.
    assert len(found) == 3 * (5 * 2 + 1 + 1)
    assert len({json.dumps(how) for how in found}) == len(found)
    assert sum(how["max_steps"] == 200 for how in found) == sum(how["training_tasks"] == 35 for how in found) == 3
    assert all(set(how) == set(KEYS) for how in found)
    assert {key: FULL["default"][key] for key in KEYS} in found


@pytest.fixture(scope="module")
def cell():
    return run_cell(SMALL, {"run": 0}, 3)


def test_a_cell_is_plain_data_with_every_method_in_every_cell_of_the_grid(cell):
    assert json.loads(json.dumps(cell)) == cell
    methods = [found["method"] for found in cell["found"]]
    # Q-learning knows neither form nor ties: 3 schedules × 2 caps.
    expected = {PLAIN: 6, **dict.fromkeys(COMPARED, len(hows(SMALL))), "qsap_noise": 3, "qpap_lattice": 3}
    assert {method: methods.count(method) for method in expected} == expected
    assert sum("curve" in found for found in cell["found"]) == 3 * (1 + len(METHODS))


def test_a_number_is_what_learning_alone_gives(run, cell):
    how = {**SMALL["default"], "form": "support", "alpha0": None, "schedule": SCHEDULE, "ties": "prior"}
    found = next(f for f in cell["found"] if f["method"] == "qpap" and all(f[key] == how[key] for key in KEYS))
    prior = exact_prior(run.training["noise"], PERCEPT, 1.0)
    schedule = schedule_of({**SMALL, "max_steps": 200}, SCHEDULE)
    returns = [
        learn_task(t.problem, rows_of(t, prior, PERCEPT, "support", "prior"), schedule)[0] for t in run.testing
    ]
    assert found["first"] == np.mean([r[0] for r in returns])
    assert found["first_ten"] == pytest.approx(np.mean([r[:10].mean() for r in returns]))


def test_leaving_out_choices_moves_no_number(cell):
    fewer = {**SMALL, "forms": ["proportion"], "alpha0": [0.1], "ties": ["uniform"], "max_steps": [200]}
    numbers = {json.dumps([f["method"], *(f[key] for key in KEYS)]): f["first_ten"] for f in cell["found"]}
    for found in run_cell(fewer, {"run": 0}, 3)["found"]:
        assert found["first_ten"] == numbers[json.dumps([found["method"], *(found[key] for key in KEYS)])]
