"""C2.7: cuts and controls as they should be, and the shares by hand."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT, ON
from reproduction.chapter2.c2_07_oversegmented_stack.run import KINDS, measure, simulated
from reproduction.chapter2.scenes.arranged_scenes import arranged

pytest.importorskip("mujoco")


@pytest.mark.parametrize("number", [0, 1])
def test_a_cut_makes_three_things_above_one_another(number):
    three = simulated("cut", 0, number)
    assert len(three.cloud.objects) == 3
    below, middle, above = (three.cloud.of(thing)[:, 2] for thing in three[1:])
    assert np.median(below) < np.median(middle) < np.median(above)


def test_a_row_stands_side_by_side_and_two_lie_on_one():
    beside = {frozenset((t.a, t.b)) for t in arranged("row", 0, 0).truth if t.relation == ADJACENT}
    assert {frozenset((2, 3)), frozenset((3, 4))} <= beside
    carried = {(t.a, t.b) for t in arranged("two-on-one", 0, 0).truth if t.relation == ON}
    assert {(3, 2), (4, 2), (2, TABLE)} <= carried


def test_measures_by_hand():
    good, bad = {"two_points": True, "stack": True}, {"two_points": False, "stack": False}
    results = [{"kind": kind, "scenes": [good, bad], "examples": []} for kind in KINDS]
    results[2]["scenes"] = [{**good, "stack": False}] * 2
    found = measure({}, results)
    assert found["two_points_stack"].value == 0.5
    assert found["structure_cut"].value == 0.5
    assert found["structure_row"].value == 0.0
    assert found["two_points_real_stack"].n == 0
