"""Pairs carried apart: by how far, along which way, one thing alone; and what is counted there, by hand."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial import KDTree

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from reproduction.chapter2.c2_11_distant_objects import run as parted_pairs
from reproduction.chapter2.c2_11_distant_objects.run import (
    away,
    bearing_pairs,
    counts,
    kernels,
    parted,
    run_cell,
    shift_to,
)
from reproduction.chapter2.c2_11_distant_objects.run import cells as pair_cells
from reproduction.chapter2.scenes import scene_lots

SETTINGS = {
    "pairs": 1,
    "gaps": [0.1, 1.0],
    "sizes": [2.0],
    "lengths": [0.06],
    "costs": [10.0],
    "camera": "kinect",
    "real": False,
}


def plate(*corner: float) -> np.ndarray:
    """A square of 5 × 5 points, 10 mm apart, lying flat: 40 mm × 40 mm × 0."""
    x, y = np.meshgrid(np.arange(5) * 0.01, np.arange(5) * 0.01)
    return np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1) + np.array(corner)


@pytest.mark.parametrize(
    ("relation", "place", "way"),
    [
        ("on", (0.3, 0.4, 0.1), (0, 0, 1)),
        # A 3-4-5 triangle, whatever the height.
        ("adjacent", (0.3, 0.4, 0.1), (0.6, 0.8, 0)),
        ("both", (-0.3, 0.4, -9.0), (-0.6, 0.8, 0)),
        # One straight above the other leaves along x.
        ("both", (0, 0, 0.1), (1, 0, 0)),
    ],
)
def test_the_way_out(relation, place, way):
    assert away(plate(*place), plate(0, 0, 0), relation) == pytest.approx(np.array(way, float))


def test_the_shift_to_a_gap_by_hand():
    other = KDTree(np.zeros((1, 3)))
    up, sideways = np.array([0.0, 0, 1]), np.array([1.0, 0, 0])
    # 30 mm beside it and 40 mm up are 50 mm; seen from 30 mm along x, 50 mm are 20 mm further.
    assert shift_to(np.array([[0.03, 0, 0]]), other, up, 0.05) == pytest.approx(0.04, abs=1e-4)
    assert shift_to(np.array([[0.03, 0, 0]]), other, sideways, 0.05) == pytest.approx(0.02, abs=1e-4)
    # Far beyond the first guess of the bisection.
    assert shift_to(np.array([[0.03, 0, 0]]), other, sideways, 2.0) == pytest.approx(1.97, abs=1e-4)
    # Further apart than asked for: it stays.
    assert shift_to(np.array([[0.03, 0, 0]]), other, sideways, 0.01) <= 1e-4


@pytest.mark.parametrize("seed", range(20))
def test_whether_a_cloud_is_nearer_than_a_gap_as_by_all_distances(seed):
    rng = np.random.default_rng(seed)
    first, second = rng.normal(size=(30, 3)), rng.normal(size=(20, 3))
    tree = KDTree(second)
    for offset in np.linspace(0, 9, 10):
        moved = first + np.array([offset, 0.0, 0.0])
        distance = np.linalg.norm(moved[:, None] - second[None], axis=2).min()
        for gap in (0.5 * distance, 0.999 * distance, 1.001 * distance, 3 * distance):
            assert parted_pairs._is_nearer(moved, tree, gap) is bool(distance < gap)


def test_one_thing_alone_is_moved_and_no_gap_is_too_wide_to_be_asked(monkeypatch):
    asked = []

    def separate(a, b, length, cost):
        asked.append((a, b, length, cost))
        every = np.arange(len(a))
        return SimpleNamespace(support_first=every, support_second=every, max_violation=0.0)

    monkeypatch.setattr(parted_pairs, "separate", separate)
    a, b = plate(0, 0, 0.02), plate(0, 0, 0)
    found = parted(SETTINGS, a, b, "on")
    # The diagonal of 40 mm × 40 mm is 56.6 mm; twice that is the last gap.
    assert found["size"] == pytest.approx(0.0566, abs=1e-4)
    assert found["gaps"] == pytest.approx([0.02, 0.1, 1.0, 2 * 0.04 * np.sqrt(2)], abs=2e-4)
    assert len(asked) == len(found["found"]) == 4
    for (one, other, length, cost), gap in zip(asked, [0.02, 0.1, 1.0, 0.11314], strict=True):
        assert (length, cost) == (0.06, 10.0)
        assert (other == b).all()
        # Every point of a went straight up by the same: its own 20 mm to the gap.
        assert one - a == pytest.approx(np.tile([0, 0, gap - 0.02], (25, 1)), abs=2e-4)
    # Points 10 mm apart are one contact of 25 (linked within 25 mm), on both sides, at every gap.
    assert found["found"] == [[gap, 0, 25, 25, 1, 1, 1, 1, 0.0] for gap in range(4)]


def test_a_separator_is_found_at_a_metre_too():
    found = parted(SETTINGS, plate(0.05, 0, 0), plate(0, 0, 0), "adjacent")
    assert found["gaps"][:3] == pytest.approx([0.01, 0.1, 1.0], abs=2e-4)
    assert all(min(row[2:4]) > 0 for row in found["found"])
    assert all(row[-1] <= 1e-3 for row in found["found"])


def test_counts_by_hand(monkeypatch):
    # Of a: seven in a row 5 mm apart, and three 100 mm off. Of b: six.
    a = np.array(
        [[0.005 * k, 0, 0] for k in range(7)] + [[0.13 + 0.005 * k, 0, 0] for k in range(3)] + [[9, 9, 9]]
    )
    b = np.array([[0.005 * k, 1, 0] for k in range(6)])
    found = SimpleNamespace(support_first=np.arange(10), support_second=np.arange(6), max_violation=0.000123)
    monkeypatch.setattr(parted_pairs, "separate", lambda *clouds, **kernel: found)
    assert counts(a, b, 0.06, 10.0) == [10, 6, 2, 1, 1, 0, 0.00012]


def made() -> tuple[LabelledCloud, list[PairLabel]]:
    """Three plates on a table; of six labels two are of things that bear a relation which nobody doubts."""
    parts = {TABLE: plate(0, 0, -0.01), 2: plate(0, 0, 0), 3: plate(0, 0, 0.01), 4: plate(0.05, 0, 0)}
    cloud = LabelledCloud(np.concatenate([*parts.values()]), np.repeat([*parts], 25))
    truth = [
        PairLabel(3, 2, "on"),
        PairLabel(2, 4, "adjacent", 2),
        PairLabel(3, 4, "adjacent", 1),
        PairLabel(4, 3, "none"),
        PairLabel(2, TABLE, "on"),
    ]
    return cloud, truth


def test_pairs_that_bear_a_relation_in_the_labels_order():
    cloud, truth = made()
    found = list(bearing_pairs(cloud, truth))
    assert [relation for *_, relation in found] == ["on", "adjacent"]
    (upper, lower, _), (left, right, _) = found
    # 10 mm apart, every point stays alone in its cell of 3 mm.
    assert [len(points) for points in (upper, lower, left, right)] == [25] * 4
    assert upper[:, 2] == pytest.approx(0.01)
    assert lower[:, 2] == pytest.approx(0)
    assert (left[:, 0].max(), right[:, 0].min()) == pytest.approx((0.04, 0.05))


def test_points_are_thinned_to_three_millimetres():
    dense = np.concatenate([plate(0, 0, 0), plate(0.0001, 0, 0), plate(0, 0.0001, 0.02)])
    cloud = LabelledCloud(dense, np.repeat([2, 2, 3], 25))
    a, b, _ = next(bearing_pairs(cloud, [PairLabel(3, 2, "on")]))
    assert len(a) == 25
    assert 25 <= len(b) < 50


def test_cells_of_pairs_and_of_real_scenes(monkeypatch):
    assert pair_cells({"pairs": 9, "real": False}) == [{"first": 0}, {"first": 4}, {"first": 8}]
    monkeypatch.setattr(scene_lots, "real_scenes_folder", lambda: None)
    assert pair_cells({"pairs": 4, "real": True}) == [{"first": 0}]
    monkeypatch.setattr(scene_lots, "real_scenes_folder", lambda: "somewhere")
    monkeypatch.setattr(scene_lots, "real_scenes", lambda: [SimpleNamespace(name=name) for name in "abcde"])
    assert pair_cells({"pairs": 4, "real": True})[1:] == [{"real": ["a", "b", "c", "d"]}, {"real": ["e"]}]


def test_a_cell_parts_every_bearing_pair_of_its_scenes(monkeypatch):
    cloud, truth = made()
    drawn = []

    def draw(seed, number, settings):
        drawn.append(number)
        return SimpleNamespace(cloud=cloud, truth=truth)

    monkeypatch.setattr(parted_pairs, "sample_scene", draw)
    found = run_cell({**SETTINGS, "pairs": 6, "gaps": [1.0]}, {"first": 4}, 0)
    assert drawn == [4, 5]
    assert found["kind"] == "simulated"
    assert [pair["relation"] for pair in found["pairs"]] == ["on", "adjacent"] * 2
    real = [SimpleNamespace(name="here", cloud=cloud, truth=truth), SimpleNamespace(name="elsewhere")]
    monkeypatch.setattr(parted_pairs, "real_scenes", lambda: real)
    found = run_cell({**SETTINGS, "gaps": [1.0]}, {"real": ["here"]}, 0)
    assert (found["kind"], len(found["pairs"])) == ("real", 2)


def test_kernels_are_every_length_with_every_cost():
    settings = {"lengths": [0.06, 0.12], "costs": [1, 10]}
    assert kernels(settings) == [(0.06, 1.0), (0.06, 10.0), (0.12, 1.0), (0.12, 10.0)]
