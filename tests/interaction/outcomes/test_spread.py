"""The spread of the tasks of a type, from runs whose tasks are known."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.spread import SHARES, Spread, spread_between


def drawn(spread: float, n_tasks: int = 400, n_runs: int = 5, seed: int = 0):
    """Outcomes of five pairs, each task with a mean of its own; noise has variance 4."""
    random = np.random.default_rng(seed)
    pairs, tasks = np.repeat(np.arange(5), n_tasks * n_runs), np.tile(np.repeat(np.arange(n_tasks), n_runs), 5)
    of_task = random.normal(scale=2 * spread**0.5, size=(5, n_tasks))
    keep = random.random(len(pairs)) < 0.8
    return pairs[keep], tasks[keep], (10 * pairs + of_task[pairs, tasks] + random.normal(0, 2, len(pairs)))[keep]


@pytest.mark.parametrize("spread", [0.0, 0.1, 1.0])
def test_the_variance_between_tasks_is_found(spread):
    found = np.array([spread_between(*drawn(spread, seed=seed)).values[0] for seed in range(8)])  # type: ignore[union-attr]
    assert found.mean() == pytest.approx(spread, abs=0.02 + 0.1 * spread)


def test_too_few_comparisons_say_nothing():
    assert spread_between(*drawn(1.0, n_tasks=3)) is None
    assert spread_between(*drawn(1.0, n_runs=1)) is None, "no task has two outcomes of a pair"
    pairs, tasks, values = drawn(1.0)
    assert spread_between(pairs, tasks, np.zeros_like(values)) is None


def test_spreads_come_back_from_arrays_and_wrong_arrays_are_refused():
    spread = Spread.up_to(2.0)
    assert spread.values == pytest.approx(2 * SHARES)
    again = Spread.of_array(np.array(spread))
    assert np.array_equal(again.values, spread.values)
    assert np.array_equal(again.weights, spread.weights)
    for wrong in ([[0.0]], [[-1.0], [1.0]], [[0.0, 1.0], [0.5, 0.4]], [[np.nan], [1.0]]):
        with pytest.raises(InputError, match="spread"):
            Spread.of_array(wrong)
    assert Spread.up_to(0.0).values.tolist() == [0.0]
