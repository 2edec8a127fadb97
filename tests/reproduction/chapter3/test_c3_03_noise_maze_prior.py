"""Claim C3.3: percepts, places and priors against slow twins; streams that methods share."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.domains.grids.noise_maze import noise_maze
from reproduction.chapter3.c3_03_noise_maze_prior.run import measure, readings, run_of
from reproduction.chapter3.learning.grid_tasks import PERCEPT, PLACE, exact_prior
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.3")
SMALL = {**CLAIM.sizes["quick"], "episodes": 30, "testing_tasks": 2, "training_tasks": 4}


@pytest.fixture(scope="module")
def run():
    return run_of(SMALL, 3, 0)


def maze_of(names):
    """The maze of a task from its stream's names, drawn as `run_of` says: density, then maze, then goal."""
    random = stream(*names, "maze")
    density = random.uniform(0.5, 0.8)
    world = noise_maze(random, 11, density)
    return density, world, int(random.integers(world.n_states))


def test_codes_by_a_slow_look_around(run):
    task = run.testing[1]
    _, world, _ = maze_of(task.stream)
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
    for task in run.noise:
        for state, best in enumerate(task.best):
            if state != task.goal:
                row = tally.setdefault(int(task.contexts[kind][state]), np.zeros(4))
                row += best
    prior = exact_prior(run.noise, 0.1, kind)
    assert prior.contexts.tolist() == sorted(tally)
    np.testing.assert_array_equal(prior.counts(sorted(tally)), [tally[code] for code in sorted(tally)])


def test_pairs_by_hand():
    def learner(first, to_80):
        return {"first": first, "mean": first + 10, "to_50": 20, "to_80": to_80}

    methods = {"q_learning": learner(-50.0, 100), "qsap": learner(-60.0, 120), "qpap": learner(-5.0, 60)}
    results = [{"optimal": 50.0, "choices": [methods]}] * 3
    found = {**next(readings(SMALL, results))[1], **measure(SMALL, results)}
    assert found["qpap_first_gain"].value == 45.0
    assert found["qpap_to_qsap_first_gain"].value == 55.0
    assert found["qpap_to_80_ratio"].value == pytest.approx(0.6)
    assert found["qpap_to_qsap_to_80_ratio"].value == pytest.approx(0.5)
    assert found["qsap_mean_gain"].value == -10.0
    assert found["to_80_qsap"].value == 120


def test_a_density_that_is_no_range():
    with pytest.raises(InputError, match="density must be two shares"):
        CLAIM.settings("quick", {"density": "[0.8, 0.5]"})
