"""The depth cameras: geometry by hand, noise by its stated size, shadows by a twin."""

import numpy as np
import pytest

from lifelore.domains.tabletop.depth_camera import KINECT, STEREO, measure, shadowed


def test_rays_and_projection_are_inverse():
    columns, rows = np.array([0, 320, 639]), np.array([479, 100, 3])
    rays = KINECT.rays(columns, rows)
    assert KINECT.project(rays * 0.7) == pytest.approx(np.stack([columns, rows], axis=1))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("camera", "depth", "stated"), [(KINECT, 0.73, 1.9e-3), (STEREO, 0.8, 0.4e-3)], ids=["kinect", "stereo"]
)
def test_noise_is_as_stated(camera, depth, stated):
    flat = np.full((480, 640), depth)
    errors = [measure(flat, camera, np.random.default_rng(seed)) - depth for seed in range(4)]
    # The slow error has some 350 independent places in four pictures: 4 % a standard deviation, three allowed.
    assert np.nanstd(errors) == pytest.approx(stated, rel=0.12)
    assert camera.sigma(depth) == pytest.approx(stated, rel=0.06)


def test_a_plane_is_whole_and_what_is_infinite_stays_unseen():
    depth = np.full((40, 40), 1.0)
    depth[:10] = np.inf
    noisy = measure(depth, STEREO, np.random.default_rng(1))
    assert np.isnan(noisy[:10]).all()
    assert np.isfinite(noisy[12:]).all()


def shadowed_slowly(disparity):
    """A pixel is dark when one further right lies between it and the projector."""
    hidden = np.zeros(disparity.shape, dtype=bool)
    for row, column in np.ndindex(disparity.shape):
        place = column - disparity[row, column]
        for other in range(column + 1, disparity.shape[1]):
            if other - disparity[row, other] < place - 0.5:
                hidden[row, column] = True
    return hidden


def test_shadows_equal_the_twin_and_fall_to_the_left():
    disparity = np.full((3, 60), 40.0)
    disparity[1, 30:40] = 50.0
    hidden = shadowed(disparity)
    assert np.array_equal(hidden, shadowed_slowly(disparity))
    # The box covers 30 … 39 at disparity 50: of the wall 20 … 29 lie behind it, seen from the projector.
    assert hidden[1].nonzero()[0].tolist() == list(range(21, 30))
    assert not hidden[[0, 2]].any()
    rng = np.random.default_rng(0)
    rough = np.repeat(rng.uniform(30, 60, (4, 12)), 5, axis=1)
    assert np.array_equal(shadowed(rough), shadowed_slowly(rough))


def test_edges_lose_points_and_planes_do_not():
    depth = np.full((100, 100), 1.0)
    depth[:, 50:] = 0.8
    lost = np.isnan(measure(depth, STEREO, np.random.default_rng(0)))
    # 200 pixels at 0.15 beside the jump, 200 at 0.05 next to them: 40 expected, variance 35; four deviations.
    assert 16 < lost.sum() < 64
    assert not lost[:, :47].any()
    assert not lost[:, 53:].any()
