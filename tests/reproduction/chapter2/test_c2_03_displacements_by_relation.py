"""C2.3: where displacements lie, by hand; and the printed signs, which no order of A and B has with y up."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.relations import ADJACENT, ON, PairLabel
from lifelore.perception.pairs.pair_features import column_names
from reproduction.chapter2.c2_03_displacements_by_relation.measure import (
    BOUNDS,
    CHOICES,
    FRACTIONS,
    all_is_so,
    measure,
    plotted,
    rows,
    sideways,
)
from reproduction.chapter2.scenes.tabletop_pairs import (
    KERNELS,
    STANDARD,
    kernel_name,
    pair_cells,
    pair_rows,
)
from reproduction.chapter2.scoring.pair_validation import displacements
from reproduction.engine.registry import claim_of

SIZES_OF_C2_1 = dict(claim_of("C2.1").sizes["full"])
CLAIM = claim_of("C2.3")
FULL = dict(claim_of("C2.3").sizes["full"])

RIGHT, BEHIND = (column_names(2).index(name) for name in ("right", "behind"))


def row(scene, relation, first, second, right=0.0, behind=0.0, turned=False):
    """A row whose contacts (mm) are the same for all kernels; `turned`: the truth names the pair in reverse."""
    features = np.zeros((2, len(column_names(2))))
    features[0, [RIGHT, BEHIND]] = right, behind
    features[1, [RIGHT, BEHIND]] = -right, -behind
    sides = {
        side: [[*(np.array(place) / 1000), 20] for place in places]
        for side, places in (("a", first), ("b", second))
    }
    return {
        "scene": scene, "a": 3 if turned else 2, "b": 2 if turned else 3, "relation": relation, "confidence": 3,
        "pair": [2, 3], "gap": 0.001, "features": features.tolist(),
        "contacts": {kernel_name(*kernel): sides for kernel in KERNELS},
    }  # fmt: skip


ROWS = [
    row("0-0", ON, [[0, 0, 10]], [[0, 0, 0]]),
    row("0-1", ON, [[1, 5, 10], [1, 5, 60]], [[0, 0, 0]]),
    # In the order of the truth a lies 8 mm above b.
    row("0-2", ON, [[0, 0, 2]], [[-1, 0, 10]], turned=True),
    row("0-3", ADJACENT, [[-9, 0, 1]], [[0, 0, 0]], right=-0.05),
    row("0-4", ADJACENT, [[4, 0, 5]], [[0, 0, 0]], right=-0.05),
    row("0-5", ADJACENT, [[6, 0, -1]], [[0, 0, 0]], right=0.05, behind=0.02, turned=True),
    row("0-6", ADJACENT, [[3, 0, 0]], [[0, 0, 0]], right=0.02, behind=0.06),
    {**row("0-7", "none", [], []), "gap": None},
]
RESULTS = [{"set": 0, "rows": ROWS}]
SETTINGS = {**FULL, "resamples": 20}


def test_measures_by_hand():
    found = measure(SETTINGS, RESULTS)
    # On: (0, 10), (1, 10), (1, 60), (-1, 8) mm; medians 0.5 and 10, so that the band ends at 2 mm.
    assert found["on_centre_sideways_of_its_rise"].value == pytest.approx(0.05)
    assert found["on_on_one_side"].value == found["on_outside_band"].value == 1
    # Adjacent: heights 1, 5, 1 and 0 mm.
    assert found["adjacent_in_band"].value == 0.75
    # To the left at -9 mm; to the left at 4 mm; turned round, to the left at -6 mm; behind: not asked.
    assert found["sign_of_x_tells_left_right"].value == pytest.approx(2 / 3)
    assert found["sign_of_x_tells_left_right"].n == 3
    assert not any(name.endswith("_real") for name in found)
    assert found["adjacent_in_band_as_printed"] == found["adjacent_in_band"]
    # In every reading the sign is right of two in three.
    assert (found["readings_in_which_all_is_so"].value, found["readings_in_which_all_is_so"].n) == (0, 36)


def test_the_other_side_counts_as_one_side_too():
    below = [row("0-0", ON, [[0, 0, -10]], [[0, 0, 0]]), row("0-1", ON, [[0, 0, -8]], [[0, 0, 0]])]
    beside = row("0-2", ADJACENT, [[9, 0, -1]], [[0, 0, 0]], right=0.05)
    found = measure(SETTINGS, [{"set": 0, "rows": [*below, beside]}])
    assert found["on_on_one_side"].value == 1
    assert found["on_outside_band"].value == found["adjacent_in_band"].value == 1
    assert found["on_on_one_side"].ci95 == (pytest.approx(0.3424, abs=1e-4), 1)
    assert found["readings_in_which_all_is_so"].value == 1


def test_bounds_are_those_filed_and_values_on_them_count():
    assert [condition.bound for condition in CLAIM.predicate.conditions] == list(BOUNDS)
    assert all_is_so(dict(zip(FRACTIONS, BOUNDS, strict=True)))
    for name, bound in zip(FRACTIONS, BOUNDS, strict=True):
        beyond = bound + (0.01 if name == FRACTIONS[0] else -0.01)
        assert not all_is_so(dict(zip(FRACTIONS, BOUNDS, strict=True)) | {name: beyond})
        assert not all_is_so(dict(zip(FRACTIONS, BOUNDS, strict=True)) | {name: None})


def test_real_pairs_stand_beside_and_do_not_decide():
    real = {"set": "real", "rows": [row("test1", ON, [[0, 0, -5]], [[0, 0, 0]])]}
    assert measure(SETTINGS, [*RESULTS, real]) == measure(SETTINGS, RESULTS)
    (middle,) = {
        tuple(line["middle_of_on"])
        for line in rows(SETTINGS, [*RESULTS, real])
        if line["scenes"] == "real" and "mm" in line
    }
    assert middle == (0, -5)


def test_left_and_right_are_in_the_order_of_the_truth():
    assert sideways(ROWS[3]) == pytest.approx(-0.05)
    assert sideways(ROWS[5]) == pytest.approx(-0.05)
    assert sideways(ROWS[6]) is None  # more behind than beside
    assert sideways(ROWS[7]) is None  # not near


@pytest.mark.parametrize(("choice", "heights"), [*zip(CHOICES, ([10, 60], [10], [10]), strict=True)])
def test_which_displacements_of_a_pair_are_looked_at(choice, heights):
    plot = plotted([ROWS[1]], STANDARD, "weak", choice, 0.05)
    assert (1000 * plot.at[:, 1]).tolist() == pytest.approx(heights)


def test_rows_hold_every_point_and_every_reading():
    found = rows(SETTINGS, RESULTS)
    points = {line["relation"]: line for line in found if "mm" in line}
    assert points[ON]["mm"] == [[0, 10], [1, 10], [1, 60], [-1, 8]]
    assert points[ADJACENT]["outside_band"] == 0.25
    readings = [line for line in found if "reading" in line]
    assert len(readings) == len(KERNELS) * 2 * len(CHOICES)
    assert all(line["adjacent_in_band"] == 0.75 for line in readings)


def test_nothing_on_anything_cannot_be_tested():
    found = {name: number.to_dict() for name, number in measure(SETTINGS, [{"set": 0, "rows": ROWS[3:]}]).items()}
    assert CLAIM.predicate.verdict(found) == "cannot be tested"


def test_pairs_are_those_of_c2_1(monkeypatch):
    monkeypatch.delenv("LIFELORE_DATA", raising=False)
    assert pair_cells(FULL) == pair_cells(SIZES_OF_C2_1)
    assert {key: FULL[key] for key in ("data_sets", "pairs", "camera", "real", "omega")} == {
        key: SIZES_OF_C2_1[key] for key in ("data_sets", "pairs", "camera", "real", "omega")
    }


def block(middle, size=0.04, step=0.003):
    """Points on the faces of a cube, metres."""
    side = np.arange(-size / 2, size / 2 + 1e-9, step)
    grid = np.stack(np.meshgrid(side, side, side), axis=-1).reshape(-1, 3)
    return grid[(np.abs(grid) > size / 2 - step / 2).any(axis=1)] + middle


def only_row(relation, a, b):
    """The row of two blocks whose middles are given in metres; the camera stands where y is negative."""
    clouds = block(np.array(a)), block(np.array(b))
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
