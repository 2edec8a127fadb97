"""C2.3: where displacements lie, by hand; and the printed signs, which no order of A and B has with y up."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.relations import ADJACENT, ON, PairLabel
from reproduction.chapter2.c2_03_displacements_by_relation.run import CHOICES, measure, plotted
from reproduction.chapter2.scenes.tabletop_pairs import KERNEL_NAMES, STANDARD, pair_rows
from reproduction.chapter2.scoring.pair_validation import FIXED, Reading, displacements
from tests.perception.conftest import box_surface


def row(scene, relation, first, second, right=0.0, behind=0.0):
    """A row whose contacts (mm) are the same for all kernels."""
    sides = {
        side: [[*(np.array(place) / 1000), 20] for place in places]
        for side, places in (("a", first), ("b", second))
    }
    return {
        "scene": scene, "relation": relation, "gap": 0.001, "centres": [right, behind, 0.0],
        "contacts": dict.fromkeys(KERNEL_NAMES, sides),
    }  # fmt: skip


ROWS = [
    row("0-0", ON, [[0, 0, 10]], [[0, 0, 0]]),
    row("0-1", ON, [[1, 5, 10], [1, 5, 60]], [[0, 0, 0]]),
    row("0-2", ON, [[-1, 0, 10]], [[0, 0, 2]]),
    row("0-3", ADJACENT, [[-9, 0, 1]], [[0, 0, 0]], right=-0.05),
    row("0-4", ADJACENT, [[4, 0, 5]], [[0, 0, 0]], right=-0.05),
    row("0-5", ADJACENT, [[0, 0, 0]], [[6, 0, -1]], right=-0.05, behind=-0.02),
    row("0-6", ADJACENT, [[3, 0, 0]], [[0, 0, 0]], right=0.02, behind=0.06),
    {**row("0-7", "none", [], []), "gap": None},
]
RESULTS = [{"set": 0, "rows": ROWS}]
SETTINGS = {"omega": 0.05, "resamples": 20}


def test_measures_by_hand():
    found = measure(SETTINGS, RESULTS)
    # On, y down: (0, -10), (1, -10), (1, -60), (-1, -8) mm; medians 0.5 and -10, so that the band ends at -2 mm.
    assert found["on_sideways_of_its_rise"].value == pytest.approx(0.05)
    assert found["on_outside_band"].value == 1
    # Adjacent: heights 1, 5, 1 and 0 mm.
    assert found["adjacent_in_band"].value == 0.75
    # To the left at -9 mm; to the left at 4 mm; to the left at -6 mm; behind: not asked.
    assert found["sign_of_x_tells_left_right"].value == pytest.approx(2 / 3)
    assert found["sign_of_x_tells_left_right"].n == 3


def test_the_band_is_on_the_other_side_of_the_on_cluster_wherever_that_lies():
    below = [row("0-0", ON, [[0, 0, -10]], [[0, 0, 0]]), row("0-1", ON, [[0, 0, -8]], [[0, 0, 0]])]
    beside = row("0-2", ADJACENT, [[9, 0, -1]], [[0, 0, 0]], right=0.05)
    found = measure(SETTINGS, [{"set": 0, "rows": [*below, beside]}])
    assert found["on_outside_band"].value == found["adjacent_in_band"].value == 1


@pytest.mark.parametrize(("choice", "heights"), [*zip(CHOICES, ([10, 60], [10], [10]), strict=True)])
def test_which_displacements_of_a_pair_are_looked_at(choice, heights):
    plot = plotted([ROWS[1]], Reading(STANDARD, FIXED), choice, 0.05)
    assert (-1000 * plot.at[:, 1]).tolist() == pytest.approx(heights)


def only_row(relation, a, b):
    """The row of two blocks whose middles are given in metres; the camera stands where y is negative."""
    clouds = [box_surface(np.array(middle) - 0.02, np.array(middle) + 0.02, 0.003) for middle in (a, b)]
    labels = np.repeat([2, 3], [len(cloud) for cloud in clouds])
    cloud = LabelledCloud(np.concatenate(clouds), labels, None, np.array([0.0, -0.7, 0.5]))
    (found,) = pair_rows("blocks", cloud, [PairLabel(2, 3, relation)])
    return found


def test_no_order_of_a_and_b_gives_both_printed_signs_with_y_up():
    upon = displacements(only_row(ON, (0, 0, 0.064), (0, 0, 0.02)))
    left = displacements(only_row(ADJACENT, (-0.044, 0, 0.02), (0, 0, 0.02)))
    # As §2.3.5 defines it, d = A - B: A to the left of B has the printed negative x, A on B a positive y.
    assert (upon[:, 2] > 0).all()
    assert (left[:, 0] < 0).all()
    # Printed are a negative y for on and a negative x for left: both hold of A - B if y points down, as in a
    # camera's picture, and of neither order if it points up.
    for order in (1, -1):
        assert not ((order * upon[:, 2] < 0).all() and (order * left[:, 0] < 0).all())
