"""C2.11: shares and means on rows made by hand; and what a separator of things far apart must have (errata)."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from lifelore.perception.contacts.contact_points import linked
from lifelore.perception.contacts.interface import DEFAULT_CONTACT_SETTINGS
from lifelore.perception.separation.separator import separate
from reproduction.chapter2.c2_11_distant_objects.measure import (
    both_are_so,
    findings,
    measure,
    pair_counts,
    pairs_table,
    rows,
)
from reproduction.engine.registry import claim_of

C2_11 = claim_of("C2.11")

COUNTS = np.array(
    [
        # Support vectors and contacts of a and b, contacts of 7 of a and b, violation.
        [8, 8, 8, 8, 0, 0, 0.0],
        [20, 10, 2, 1, 1, 0, 0.0],
        [14, 8, 2, 1, 2, 1, 0.0],
        [3, 0, 1, 0, 0, 0, 0.0],
    ]
)
SETTINGS = {"gaps": [0.1, 1.0], "sizes": [], "lengths": [0.06, 0.25], "costs": [10.0]}


def test_answers_of_pairs_by_hand():
    found = [pair_counts(counts) for counts in COUNTS]
    assert [one["none_of_7"] for one in found] == [True, False, False, True]
    assert [one["both_of_7"] for one in found] == [False, False, True, False]
    assert [one["no_support"] for one in found] == [False, False, False, True]
    assert [one["support"] for one in found] == [8, 15, 11, 1.5]


def pair(*found: tuple, size: float = 0.1) -> dict:
    """A pair's row: by gap (as seen, 0.1 m, 1 m) and kernel (60 and 250 mm) what was counted."""
    numbered = [[gap, kernel, *found[2 * gap + kernel]] for gap in range(3) for kernel in range(2)]
    return {"relation": "on", "size": size, "gaps": [0.005, 0.1, 1.0], "found": numbered}


BOTH_SIDES = (30, 10, 1, 1, 1, 1, 0.0)
ONE_SIDE = (10, 6, 1, 1, 1, 0, 0.0)
WEAK = (6, 4, 6, 4, 0, 0, 0.0)
STRONG_UNFINISHED = (6, 4, 6, 4, 1, 0, 0.01)


@pytest.fixture
def results() -> list[dict]:
    """Four pairs: under 60 mm contacts as seen of 3 and none far of 3; under 250 mm of 4 and of 1."""
    # As seen, at 0.1 m and at 1 m; of each 60 mm, then 250 mm.
    pairs = [
        pair(BOTH_SIDES, BOTH_SIDES, WEAK, WEAK, WEAK, WEAK),
        pair(BOTH_SIDES, BOTH_SIDES, WEAK, WEAK, WEAK, ONE_SIDE),
        pair(BOTH_SIDES, BOTH_SIDES, WEAK, WEAK, WEAK, ONE_SIDE, size=0.2),
        pair(ONE_SIDE, BOTH_SIDES, WEAK, WEAK, BOTH_SIDES, STRONG_UNFINISHED, size=0.2),
    ]
    return [{"kind": "simulated", "pairs": pairs[:3]}, {"kind": "simulated", "pairs": pairs[3:]}]


def test_a_table_holds_every_pair_of_its_kind(results):
    table = pairs_table(SETTINGS, [*results, {"kind": "real", "pairs": [pair(*[WEAK] * 6)]}])
    assert table.values("support", kind="simulated", gap=0, kernel=0).tolist() == [20, 20, 20, 8]
    assert table.values("support", kind="real", gap=2, kernel=1).tolist() == [5]
    assert len(table) == 4 * 3 * 2 + 6


def test_measures_by_hand(results):
    found = measure(SETTINGS, results)
    values = {name: one.value for name, one in found.items()}
    assert values["no_contacts_far_standard_simulated"] == 3 / 4
    assert values["contacts_as_seen_standard_simulated"] == 3 / 4
    # Means of an object: weak 5 (three pairs), both sides 20; as seen 20 (three pairs), one side 8.
    assert values["support_vectors_far_standard_simulated"] == pytest.approx((5 + 5 + 5 + 20) / 4)
    assert values["far_over_seen_standard_simulated"] == pytest.approx((0.25 * 3 + 20 / 8) / 4)
    # The best kernel is the one whose worse share is the better: 3/4 and 3/4 against 1 and 1/4.
    assert values["contacts_as_seen_best_kernel_simulated"] == 3 / 4
    assert values["no_contacts_far_best_kernel_simulated"] == 3 / 4
    assert values["no_support_vectors_on_a_side_far_simulated"] == 0
    assert found["no_support_vectors_on_a_side_far_simulated"].n == 8
    interval = found["no_contacts_far_standard_simulated"].ci95
    # Three in four is too few, whatever the kernel.
    assert (values["kernels_in_which_both_are_so"], found["kernels_in_which_both_are_so"].n) == (0, 2)
    # Clopper and Pearson of 3 in 4, from tables.
    assert interval == pytest.approx((0.1941, 0.9937), abs=1e-4)
    by_kernel = findings(SETTINGS, results)["simulated"]
    assert by_kernel["250 mm, C 10"]["no_contacts_far"].value == 1 / 4
    assert by_kernel["250 mm, C 10"]["contacts_as_seen"].value == 1.0
    # 4 pairs, 3 gaps, 2 kernels; one of the 24 separators is not optimal.
    assert (by_kernel["all"]["not_optimal"].value, by_kernel["all"]["not_optimal"].n) == (1 / 24, 24)
    # 1 m is 10 sizes of two pairs and 5 of the others.
    assert by_kernel["all"]["far_in_sizes"].value == pytest.approx(7.5)


@pytest.mark.parametrize(
    ("none", "few", "so"),
    [
        ((0.95, 1), (1, 10), True),
        ((0.949, 1), (1, 10), False),
        ((0.95, 1), (1, 10.1), False),
        (None, (1, 2), False),
    ],
)
def test_both_are_so_by_whole_intervals(none, few, so):
    ends = {"no_contacts_far": none, "support_vectors_far": few}
    assert both_are_so({name: Estimate(1.0, 1.0, own, 9) for name, own in ends.items()}) is so


def test_rows_by_hand(results):
    made = rows(SETTINGS, results)
    assert len(made) == 6 + 3
    first = made[0]
    assert (first["kernel"], first["gap"], first["unit"], first["pairs"]) == ("60 mm, C 10", 0.005, "as seen", 4)
    # Support as seen: 20, 20, 20, 8; its median 20, its lower quartile 8 + 3/4 of the way to 20.
    assert first["support"] == [20, 17, 20]
    assert first["none_of_7"] == 0
    assert made[2]["none_of_7"] == 0.75
    assert [row["estimates of kernel"] for row in made[6:]] == ["60 mm, C 10", "250 mm, C 10", "all"]


def test_gaps_must_hold_a_metre():
    with pytest.raises(InputError, match="gaps must hold 1 m"):
        C2_11.settings("quick", {"gaps": [0.1]})


# --- far apart there are support vectors all the same (errata) ---------------------------------------------


def cube(side: float, *corner: float, step: float = 0.006) -> np.ndarray:
    """The surface of a cube as points `step` apart."""
    axis = np.arange(round(side / step) + 1) * step
    grid = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    return grid[((grid == axis[0]) | (grid == axis[-1])).any(axis=1)] + np.array(corner or (0, 0, 0))


@pytest.mark.parametrize("distance", [0.05, 1.0, 10.0])
def test_two_points_are_two_support_vectors_however_far_apart(distance):
    found = separate([[0, 0, 0]], [[distance, 0, 0]], length=0.06, cost=1e4)
    # Most of 2 α - α² (1 - k): α = 1 / (1 - k), k what the kernel says of the two, which is 0 from afar.
    alpha = 1 / (1 - np.exp(-((distance / 0.06) ** 2) / 2))
    assert found.alpha_first == pytest.approx([alpha], rel=1e-3)
    assert found.alpha_second == pytest.approx([alpha], rel=1e-3)


@pytest.mark.parametrize("apart", [1.0, 2.0])
def test_far_apart_a_separator_describes_each_thing_by_its_own_corners(apart):
    side = DEFAULT_CONTACT_SETTINGS.length
    found = separate(
        cube(side, 0, 0, side + apart), cube(side), length=side, cost=DEFAULT_CONTACT_SETTINGS.cost, tolerance=1e-6
    )
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
    first, second = cube(0.06, 0, 0, 1.06), cube(0.06)
    found = separate(first, second, length=length, cost=cost)
    assert found.max_violation <= 1e-3
    assert min(len(found.alpha_first), len(found.alpha_second)) > 0
    # The multipliers of both sides have one sum, and it is not zero.
    assert found.alpha_first.sum() == pytest.approx(found.alpha_second.sum())
    assert found.alpha_first.sum() > 0.5
    # They are what separates: every point lies on its side.
    assert (found.decision(first) > 0).all()
    assert (found.decision(second) < 0).all()


def test_a_long_kernel_takes_few_points_far_apart_and_hundreds_near():
    def strongest(gap: float) -> tuple[int, int]:
        found = separate(cube(0.06, 0, 0, 0.06 + gap, step=0.003), cube(0.06, step=0.003), length=0.25, cost=10.0)
        sizes = [
            np.bincount(linked(side, DEFAULT_CONTACT_SETTINGS.linkage))
            for side in (found.points_first, found.points_second)
        ]
        return max(map(len, (found.points_first, found.points_second))), int(max(map(max, sizes)))

    near, far = strongest(0.006), strongest(1.0)
    assert near[1] >= 7 > far[1] >= 1
    assert 1 <= far[0] <= 8 < near[0]
