"""The reserve by hand, by a plain loop and by many deployments."""

import math

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.surveillance.surveillance import BASE, HILLS, LAYOUTS, METRICS, SIDE, Surveillance

EVERY = pytest.mark.parametrize(("layout", "metric"), [(la, m) for la in LAYOUTS for m in METRICS])


def _plain_mean(world: Surveillance) -> np.ndarray:
    n = world.n_targets
    mean = np.empty((n, n))
    for type_ in range(n):
        for policy in range(n):
            (a, b), (c, d) = world.targets[type_], world.targets[policy]
            rows, columns = abs(int(a - c)), abs(int(b - d))
            far = max(rows, columns) if world.metric == "chebyshev" else math.sqrt(rows**2 + columns**2)
            hilltop = (int(c), int(d)) in HILLS
            pay = 0.0
            if hilltop and far <= 15:
                pay = 200 - 30 * far
            elif not hilltop and far <= 3:
                pay = 200 - 20 * far
            mean[type_, policy] = pay + 10
    return mean


@EVERY
def test_means_equal_the_plain_loop(layout, metric):
    world = Surveillance(layout, metric)
    assert world.mean == pytest.approx(_plain_mean(world), abs=1e-9)


@EVERY
def test_each_target_is_best_surveyed_itself(layout, metric):
    mean = Surveillance(layout, metric).mean
    assert (mean.diagonal() == 210).all()
    assert (mean - np.eye(68) * 1000 < 210).all()


@EVERY
def test_targets(layout, metric):
    world = Surveillance(layout, metric)
    assert world.targets.shape == (68, 2)
    assert len(np.unique(world.targets, axis=0)) == 68
    assert world.targets.min() >= 0
    assert world.targets.max() < SIDE
    assert list(BASE) not in world.targets.tolist()
    assert sorted(map(tuple, world.targets[world.is_hilltop].tolist())) == sorted(HILLS)


def test_layouts_by_hand():
    assert set(LAYOUTS["X"]) == {(i * k, j * k) for k in (1, 2, 3, 4) for i in (-1, 1) for j in (-1, 1)}
    assert {abs(i) + abs(j) for i, j in LAYOUTS["diamond"]} == {4}
    assert {max(abs(i), abs(j)) for i, j in LAYOUTS["ring"]} == {2}
    assert {len(set(cells)) for cells in LAYOUTS.values()} == {16}


def test_unseen_tasks_lie_near_hills_and_are_mostly_no_targets():
    world = Surveillance()
    assert world.cells_near_hills.shape == (324, 2)
    drawn = world.draw_cells(np.random.default_rng(1), 2000, seen=False)
    assert np.abs(drawn[:, None] - np.array(HILLS)).max(axis=-1).min(axis=-1).max() == 4
    targets = set(map(tuple, world.targets.tolist()))
    assert np.mean([tuple(cell) in targets for cell in drawn.tolist()]) == pytest.approx(68 / 324, abs=0.05)
    assert set(map(tuple, world.draw_cells(np.random.default_rng(1), 500).tolist())) <= targets


@pytest.mark.parametrize(
    ("changes", "error", "rule"),
    [
        ({"layout": "star"}, NotFoundError, "layout must be one of X"),
        ({"metric": "taxi"}, NotFoundError, "metric must be one of"),
        ({"deviation": -1.0}, InputError, "deviation must be finite"),
        ({"deviation": float("nan")}, InputError, "deviation must be finite"),
    ],
)
def test_reserves_that_cannot_be(changes, error, rule):
    with pytest.raises(error, match=rule):
        Surveillance(**changes)
