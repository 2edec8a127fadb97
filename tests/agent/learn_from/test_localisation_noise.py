"""The noise of poses is estimated from poses alone: exact on straight lines, and close for drawn noise."""

import numpy as np
import pytest

from lifelore.agent.learn_from.localisation_noise import localisation_noise
from lifelore.agent.learn_from.run_log import Run
from lifelore.core.streams import stream


def run(points) -> Run:
    n = len(points)
    return Run("r", np.arange(n) * 0.2, points, np.full(n, np.nan), [""] * n)


def square(side: float, spacing: float):
    """Points on a square of straight sides."""
    along = np.arange(0, side, spacing)
    zeros, far = np.zeros_like(along), np.full_like(along, side)
    sides = [(along, zeros), (far, along), (far - along, far), (zeros, far - along)]
    return np.concatenate([np.column_stack(one) for one in sides])


@pytest.mark.parametrize("spacing", [0.05, 0.1, 0.5])
def test_straight_drives_have_no_noise(spacing):
    assert localisation_noise([run(square(8, spacing))]) < 1e-9


# 1,600 poses: the median has a standard error of some 3 %, twice that because neighbours share poses.
@pytest.mark.parametrize("sigma", [0.02, 0.05, 0.25])
@pytest.mark.parametrize("spacing", [0.1, 0.3])
def test_drawn_noise_is_found(sigma, spacing):
    points = square(1600 * spacing / 4, spacing)
    noisy = points + stream(3, "noise", sigma, spacing).normal(0, sigma, points.shape)
    assert 0.75 * sigma < localisation_noise([run(noisy)]) < 1.25 * sigma


def test_stairs_and_a_drive_to_and_fro_have_no_noise():
    """A pose in each cell of a staircase, and bumps into a wall again and again."""
    stairs = np.cumsum(np.tile([[0.5, 0.0], [0.0, 0.5]], (50, 1)), axis=0)
    fro = np.column_stack([np.tile([0.0, 0.2], 50), np.repeat(np.arange(50) * 0.5, 2)])
    assert localisation_noise([run(stairs)]) < 1e-9
    assert localisation_noise([run(fro)]) < 0.05


def test_poses_at_rest_and_short_runs_do_not_count():
    assert localisation_noise([run(np.zeros((50, 2))), run(np.ones((2, 2)))]) == 0
    assert localisation_noise([]) == 0
