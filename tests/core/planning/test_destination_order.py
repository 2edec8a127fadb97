"""Orders of destinations: by hand, and against all orders of all subsets."""

from itertools import permutations

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.planning.destination_order import MOST_EXACT, by_exact_search, by_rate


def expected_time(order, steps, chance, elsewhere, tour) -> float:
    """Expected steps until the goal is found if the places are tried in this order before the tour."""
    time, here, total, left = 0.0, len(chance), 0.0, elsewhere + float(np.sum(chance))
    for place in order:
        time += steps[here, place]
        total += chance[place] * time
        left -= chance[place]
        here = place
    return total + left * (time + tour / 2)


def on_a_line(start: float, *places: float) -> np.ndarray:
    points = np.array([*places, start])
    return np.abs(points[:, None] - points[None, :-1])


def test_by_hand():
    steps = on_a_line(0.0, 2.0, -3.0, 30.0)
    chance = np.array([0.1, 0.3, 0.5])
    assert by_rate(steps, chance, 0.1, 100.0) == [1, 0, 2]
    # A tour that is faster than the way to the last place comes before it.
    assert by_rate(steps, chance, 0.1, 2.0) == [1]
    assert by_exact_search(steps, chance, 0.1, 1e6) == [1, 0, 2]
    # 0.1 · 2 + 0.3 · 7 + 0.5 · 40 + 0.1 · (40 + 50)
    assert expected_time([0, 1, 2], steps, chance, 0.1, 100.0) == pytest.approx(31.3)


@pytest.mark.parametrize("seed", range(8))
def test_the_exact_search_is_the_best_of_all_orders_of_all_subsets(seed):
    random = np.random.default_rng(seed)
    n = 5
    points = random.uniform(0, 50, (n + 1, 2))
    steps = np.abs(points[:, None] - points[None, :n]).sum(axis=-1)
    chance = random.dirichlet(np.ones(n + 1))
    task = steps, chance[:n], float(chance[n]), 200.0
    least = min(expected_time(list(way), *task) for size in range(n + 1) for way in permutations(range(n), size))
    assert expected_time(by_exact_search(*task), *task) == pytest.approx(least)
    assert expected_time(by_rate(*task), *task) >= least - 1e-9


def test_the_limits_of_the_exact_search():
    assert by_exact_search(np.zeros((1, 0)), np.zeros(0), 1.0, 10.0) == []
    n = MOST_EXACT + 1
    with pytest.raises(InputError, match=f"at most {MOST_EXACT} places"):
        by_exact_search(np.ones((n + 1, n)), np.full(n, 1 / n), 0.0, 10.0)
