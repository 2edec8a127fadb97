"""What each peer sees of a pair, worked by hand and beside a plain twin."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.relations import PairLabel
from lifelore.perception.peers import angle_distance_histogram as angles
from lifelore.perception.peers import orientation_histogram as orientation
from lifelore.perception.peers.angle_distance_histogram import angle_distance_histogram
from lifelore.perception.peers.bounding_box_rule import BoundingBoxRule, boxes
from lifelore.perception.peers.centroid_neighbours import centroid_displacement
from lifelore.perception.peers.closest_point import closest_displacement
from lifelore.perception.peers.majority import Majority
from lifelore.perception.peers.orientation_histogram import orientation_histogram
from lifelore.perception.peers.peer import DescribedPair

from .conftest import box

HIGH = np.array([[0.0, 0.0, 0.10]])
LOW = np.array([[0.0, 0.0, 0.05]])


def test_centroid_displacement_by_hand():
    first, second = np.array([[0.0, 0, 1], [2, 0, 1]]), np.array([[0.0, 3, 0]])
    assert centroid_displacement(first, second).tolist() == [1, -3, 1]


def test_closest_displacement_is_of_the_closest_points_alone():
    first = np.array([[0.0, 0, 0.06], [0.0, 0, 0.5]])
    second = np.array([[0.0, 0, 0.05], [0.3, 0, 0.05], [0.0, 0.4, 0]])
    assert closest_displacement(first, second) == pytest.approx([0, 0, 0.01])
    assert closest_displacement(second, first) == pytest.approx([0, 0, -0.01])


def test_closest_displacement_finds_what_is_farther_than_any_near_pair():
    assert closest_displacement(np.array([[1.0, 0, 0]]), np.array([[0.0, 0, 0]])) == pytest.approx([1, 0, 0])


def test_orientation_histogram_by_hand():
    # 5 cm straight up: the last elevation bin, and the third distance bin, 4 to 7 cm.
    above = orientation_histogram(HIGH, LOW).reshape(orientation.ELEVATION_BINS, -1)
    assert above[-1, 2] == 1
    assert above.sum() == 1
    # Level at 20 cm: the first bin above the middle, 16 to 23 cm.
    level = orientation_histogram(HIGH + np.array([0.2, 0, 0]), HIGH).reshape(orientation.ELEVATION_BINS, -1)
    assert level[orientation.ELEVATION_BINS // 2, 5] == 1


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 10_000), st.floats(0, 6.28))
def test_orientation_histogram_does_not_see_the_heading(seed, turn):
    rng = np.random.default_rng(seed)
    # Points far apart, so that coarse cells hold one each whichever way they are turned.
    first, second = (rng.integers(0, 4, (5, 3)) * 0.1 + shift for shift in (0.0, np.array([0.45, 0, 0])))
    turned = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    first, second = np.unique(first, axis=0), np.unique(second, axis=0)
    # Off the edges of the bins, which rounding would move points across.
    first = first + np.array([0.013, 0.007, 0.0171])
    assert orientation_histogram(first @ turned.T, second @ turned.T) == pytest.approx(
        orientation_histogram(first, second)
    )


def naive_angles(first, second):
    """The three histograms of Mees et al., point pair by point pair."""
    centre, down = first.mean(axis=0), np.array([0.0, 0.0, -1.0])
    own, planes, lengths = np.zeros(18), np.zeros(18), []
    for p in first:
        for q in second:
            r, d = p - centre, q - p
            lengths.append(np.linalg.norm(d))
            for count, u, v in ((own, r, d), (planes, np.cross(r, down), np.cross(d, r))):
                size = np.linalg.norm(u) * np.linalg.norm(v)
                angle = np.arccos(np.clip(u @ v / size, -1, 1)) if size > 1e-12 else np.pi / 2
                count[min(int(angle / np.pi * 18), 17)] += 1
    near = sorted(lengths)[: max(1, int(0.01 * len(lengths)))]
    distances = np.histogram(near, [0, 0.06, 0.20, np.inf])[0]
    return np.concatenate([own / own.sum(), planes / planes.sum(), distances / len(near)])


@pytest.mark.parametrize("seed", range(5))
def test_angle_distance_histogram_is_its_plain_twin(seed):
    rng = np.random.default_rng(seed)
    first, second = rng.uniform(0, 0.2, (30, 3)), rng.uniform(0, 0.2, (40, 3)) + np.array([0, 0, 0.1])
    coarse_first, coarse_second = (angles.mean_of_voxels(points, angles.GRAIN) for points in (first, second))
    assert angle_distance_histogram(first, second) == pytest.approx(naive_angles(coarse_first, coarse_second))


def test_boxes_by_hand():
    top, bottom = box((0.0, 0, 0.1), (0.1, 0.1, 0.1)), box((0.05, 0, 0), (0.1, 0.2, 0.1))
    low, high, other_low, other_high, overlap = boxes(top, bottom)
    assert (low, high, other_low, other_high) == pytest.approx((0.1, 0.2, 0.0, 0.1), abs=0.002)
    assert overlap == pytest.approx(0.5)


def seen(*rows: list[float], gap: float = 0.001, b: int = 3) -> tuple[DescribedPair]:
    return (DescribedPair(2, b, gap, np.array(rows, float)),)


@pytest.mark.parametrize(
    ("row", "gap", "b", "expected"),
    [
        ([0.1, 0.2, 0.0, 0.11, 1.0], 0.001, 3, (2, 3, "on")),
        ([0.0, 0.1, 0.09, 0.2, 1.0], 0.001, 3, (3, 2, "on")),
        ([0.04, 0.2, 0.0, 0.1, 1.0], 0.001, 3, (2, 3, "both")),
        ([0.0, 0.1, 0.03, 0.2, 1.0], 0.001, 3, (3, 2, "both")),
        ([0.0, 0.1, 0.0, 0.1, 0.0], 0.020, 3, (2, 3, "adjacent")),
        ([0.0, 0.1, 0.0, 0.1, 0.0], 0.025, 3, (2, 3, "none")),
        ([0.1, 0.2, 0.0, 0.11, 0.1], 0.025, 3, (2, 3, "none")),
        ([0.01, 0.2, 0.0, 0.0, 1.0], 0.001, 1, (2, 1, "on")),
        ([0.03, 0.2, 0.0, 0.0, 1.0], 0.001, 1, (2, 1, "none")),
    ],
)
def test_the_rule_of_boxes(row, gap, b, expected):
    (said,) = BoundingBoxRule().predict_pairs(seen(row, gap=gap, b=b))
    assert (said.a, said.b, said.relation) == expected


def test_majority_counts_objects_and_table_apart():
    scene = (*seen([0, 0, -0.1], [0, 0, 0.1]), *seen([0, 0, 0.1], [0, 0, -0.1], b=1))
    truths = [(PairLabel(3, 2, "on"), PairLabel(2, 1, "none"))] * 2 + [(PairLabel(2, 3, "both"),)]
    said = Majority().fit_pairs([scene] * 3, truths).predict_pairs(scene)
    # Of three pairs of objects two are on, and 3 has the higher centroid; of two with the table both are none.
    assert [(one.a, one.b, one.relation, one.confidence) for one in said] == [
        (3, 2, "on", pytest.approx(2 / 3)),
        (2, 1, "none", 1.0),
    ]
