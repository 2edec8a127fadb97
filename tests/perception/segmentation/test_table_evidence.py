"""Evidence for and against a floor as the table: boxes that stand, boxes that float, legs, and a wall's noise."""

import numpy as np
import pytest

from lifelore.core.streams import stream
from lifelore.perception.segmentation.surface_patches import oriented_voxels, patches
from lifelore.perception.segmentation.table_evidence import Candidate, candidates_of
from lifelore.perception.segmentation.table_search import BACKGROUND_AREA, find_table

UP = np.array([0.0, 0.0, 1.0])


def sheet(low, high, step=0.012) -> np.ndarray:
    """A box's surface, or a flat sheet where two corners share a coordinate."""
    axes = [np.linspace(a, b, max(2, round((b - a) / step) + 1)) for a, b in zip(low, high, strict=True)]
    points = np.unique(np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3), axis=0)
    return points[((points == np.array(low)) | (points == np.array(high))).any(axis=1)]


FLOOR = sheet((-1, -1, 0), (1, 1, 0))


def boxes(bottom: float) -> np.ndarray:
    """Three boxes of a hand's size, each with its bottom at that height."""
    return np.concatenate(
        [sheet((x, -0.1, bottom), (x + 0.12, 0.05, bottom + 0.15), 0.008) for x in (-0.4, 0.0, 0.4)]
    )


def judged(points: np.ndarray) -> Candidate:
    """The largest level patch of a cloud, its upper side up."""
    voxels = oriented_voxels(points, None, np.ones(len(points), bool))
    found = patches(voxels, stream(0, "perception", "table search"))
    large = [patch for patch in found if patch.area >= BACKGROUND_AREA]
    level = [c for c in candidates_of(voxels, found, large, None) if c.plane.normal @ UP > 0.99]
    return max(level, key=lambda c: c.patch.area)


def test_boxes_stand_on_a_floor():
    one = judged(np.concatenate([FLOOR, boxes(0.0)]))
    assert 0.7 * len(boxes(0.0)) < one.standing <= len(boxes(0.0))
    assert (one.tall, one.hanging, one.floating) == (0, 0, 0)
    assert find_table(np.concatenate([FLOOR, boxes(0.0)]), up=UP).table is not None


def test_tops_that_a_camera_above_sees_alone_do_not_float():
    tops = boxes(0.0)
    points = np.concatenate([FLOOR, tops[tops[:, 2] == 0.15]])
    assert judged(points).floating == 0
    assert find_table(points, camera=np.array([0.0, 0.0, 1.5])).table is not None


@pytest.mark.parametrize("aside", [0.0, 1.5])
def test_boxes_on_glass_float_and_the_floor_is_no_table(aside):
    # Beside the floor too: what is seen of it begins behind the objects.
    points = np.concatenate([FLOOR, boxes(0.7) - aside * np.array([0, 1, 0])])
    one = judged(points)
    assert (one.standing, one.tall, one.floating) == (0, 0, len(boxes(0.7)))
    assert one.hanging == (0 if aside else len(boxes(0.7)))
    assert find_table(points, up=UP).table is None
    # The floor alone is a bare table.
    assert find_table(FLOOR, up=UP).table is not None


def test_the_legs_of_a_glass_table_are_tall_and_the_floor_is_no_table():
    legs = [sheet((x, y, 0), (x + 0.04, y + 0.04, 0.7)) for x in (-0.5, 0.5) for y in (-0.3, 0.3)]
    points = np.concatenate([FLOOR, *legs])
    one = judged(points)
    assert one.standing == 0
    assert one.tall > 0.9 * sum(map(len, legs)) - 200
    assert find_table(points, up=UP).table is None


def test_what_floats_counts_against_what_stands():
    small = sheet((0.6, 0.6, 0.0), (0.7, 0.7, 0.1), 0.008)
    aside = boxes(0.7) - np.array([0, 1.5, 0])
    many, few = (np.concatenate([FLOOR, small, some]) for some in (aside, aside[: len(small)]))
    assert judged(many).floating > 5 * judged(many).standing > 0
    assert find_table(many, up=UP).table is None
    assert judged(few).floating == len(small)
    assert find_table(few, up=UP).table is not None


def test_the_noise_of_a_wall_does_not_stand_on_the_floor():
    wall = sheet((-1, 1, 0), (1, 1, 2.0))
    noise = sheet((-0.1, 0.985, 0.02), (0.1, 0.985, 0.22), 0.01)
    # A few voxels where the wall meets the floor are left.
    assert judged(np.concatenate([FLOOR, wall, noise])).standing < 0.15 * len(noise)
    # The same points without the wall are an object.
    assert judged(np.concatenate([FLOOR, noise])).standing > 0.9 * len(noise)


def test_what_hardly_rises_may_be_the_floor_s_own_noise():
    low, high = (sheet((0, 0, height), (0.1, 0.1, height), 0.005) for height in (0.014, 0.022))
    assert judged(np.concatenate([FLOOR, low])).standing == 0
    assert judged(np.concatenate([FLOOR, high])).standing == len(high)


def test_a_box_that_hides_most_of_the_pillar_below_it_stands_on_the_floor():
    pillar = sheet((-0.02, -0.02, 0), (0.02, 0.02, 0.12), 0.008)
    top = sheet((-0.12, -0.12, 0.24), (0.12, 0.12, 0.24), 0.004)
    one = judged(np.concatenate([FLOOR, pillar, top]))
    assert one.standing > len(top) > 5 * len(pillar)
    assert (one.hanging, one.floating) == (0, 0)
    assert judged(np.concatenate([FLOOR, top])).hanging == len(top)
