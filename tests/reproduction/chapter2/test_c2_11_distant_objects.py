"""C2.11: pairs carried apart and counted, by hand; and what a separator of objects far apart must have (E20)."""

import numpy as np
import pytest
from scipy.spatial import KDTree

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.perception.contacts.contact_points import linked
from lifelore.perception.contacts.interface import DEFAULT_CONTACT_SETTINGS
from lifelore.perception.separation.separator import separate
from reproduction.chapter2.c2_11_distant_objects import run as c2_11
from reproduction.chapter2.c2_11_distant_objects.run import away, bearing_pairs, readings, shift_to
from reproduction.chapter2.scenes.tabletop_pairs import STANDARD
from reproduction.engine.registry import claim_of
from tests.perception.conftest import box_surface

SETTINGS = {"gaps": [1.0, 0.1], "lengths": [0.25], "costs": [10.0]}


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
            assert c2_11._is_nearer(moved, tree, gap) is bool(distance < gap)


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


def test_measures_and_readings_by_hand():
    # As seen, at 0.1 m and at 1 m: support vectors of an object, contacts of both.
    first = {
        "gap": 0.004,
        "found": {STANDARD: [[20, 2], [6, 0], [5, 0]], "250 mm, C 10": [[10, 2], [5, 0], [2, 0]]},
    }
    second = {
        "gap": 0.006,
        "found": {STANDARD: [[8, 1], [6, 0], [12, 1]], "250 mm, C 10": [[10, 2], [5, 0], [2, 0]]},
    }
    results = [{"pairs": [first]}, {"pairs": [second]}]
    found, _ = claim_of("C2.11").measured(SETTINGS, results)
    assert found["no_contacts_far"].value == 0.5
    assert found["far_over_seen"].value == pytest.approx((5 / 20 + 12 / 8) / 2)
    assert [numbers["no_contacts_far"].value for _, numbers in readings(SETTINGS, results)] == [0.5, 1]


# --- far apart there are support vectors all the same (errata) ---------------------------------------------


@pytest.mark.parametrize("apart", [1.0, 2.0])
def test_far_apart_a_separator_describes_each_thing_by_its_own_corners(apart):
    side = DEFAULT_CONTACT_SETTINGS.length
    upper = box_surface((0, 0, side + apart), (side, side, 2 * side + apart), 0.006)
    lower = box_surface((0, 0, 0), (side, side, side), 0.006)
    found = separate(upper, lower, length=side, cost=DEFAULT_CONTACT_SETTINGS.cost, tolerance=1e-6)
    corners = {tuple(map(float, corner)) for corner in np.ndindex(2, 2, 2)}
    for points, alpha, foot in (
        (found.points_first, found.alpha_first, side + apart),
        (found.points_second, found.alpha_second, 0.0),
    ):
        places = np.round((points - [0, 0, foot]) / side, 6)
        assert {tuple(place.tolist()) for place in places} == corners
        # Eight alike: α times the sum of a corner's kernels with all of them, (1 + e^-1/2)³, is 1.
        assert alpha == pytest.approx(np.full(8, (1 + np.exp(-0.5)) ** -3), abs=1e-5)
        # Each is a contact of its own, of one support vector: the rule of 7 removes them, not the distance.
        assert (
            np.bincount(linked(np.ascontiguousarray(points), DEFAULT_CONTACT_SETTINGS.linkage)).tolist() == [1] * 8
        )


@pytest.mark.parametrize("length", [0.03, 0.06, 0.12, 0.25, 1.0])
@pytest.mark.parametrize("cost", [1.0, 1e4])
def test_no_kernel_leaves_a_side_without_support_vectors(length, cost):
    first, second = (box_surface((0, 0, z), (0.06, 0.06, z + 0.06), 0.006) for z in (1.06, 0))
    found = separate(first, second, length=length, cost=cost)
    assert found.max_violation <= 1e-3
    assert min(len(found.alpha_first), len(found.alpha_second)) > 0
    # The multipliers of both sides have one sum, and it is not zero.
    assert found.alpha_first.sum() == pytest.approx(found.alpha_second.sum())
    assert found.alpha_first.sum() > 0.5
    # They are what separates: every point lies on its side.
    assert (found.decision(first) > 0).all()
    assert (found.decision(second) < 0).all()
