"""C2.7: cuts and controls as they should be, and the shares by hand."""

import pytest

from reproduction.chapter2.c2_07_oversegmented_stack.run import KINDS, measure

pytest.importorskip("mujoco")


def test_measures_by_hand():
    good, bad = {"two_points": True, "stack": True}, {"two_points": False, "stack": False}
    results = [{"kind": kind, "scenes": [good, bad], "examples": []} for kind in KINDS]
    results[2]["scenes"] = [{**good, "stack": False}] * 2
    found = measure({}, results)
    assert found["two_points_stack"].value == 0.5
    assert found["structure_cut"].value == 0.5
    assert found["structure_row"].value == 0.0
    assert found["two_points_real_stack"].n == 0
