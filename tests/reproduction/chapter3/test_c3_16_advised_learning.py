"""Claim C3.16: measures, readings and curves from made-up mazes, by hand."""

import numpy as np

from reproduction.chapter3.c3_16_advised_learning.run import readings, rows
from reproduction.engine.registry import claim_of

SETTINGS = {
    **claim_of("C3.16").sizes["quick"], "episodes": 4, "loops": [0.1, 0.4], "experts": ["walks"],
    "alpha0": [0.1, 1.0], "starts": ["one", "any"], "schedule": ["printed"],
}  # fmt: skip


def maze(loops, advised):
    found = {"loops": loops, "plain": [0.1, 0.3], "advised": [[advised, 0.9], [0.2, 0.8]]}
    if loops == 0.1:
        found |= {"final_plain": 300.0, "final_advised": 700.0}
        found |= {"curve_plain": [[0, 0, 0, 1000]], "curve_advised": [[0, 1000, 1000, 1000]]}
    return found


def test_numbers_by_hand():
    results = [maze(0.1, 0.4), maze(0.1, 0.6), maze(0.4, 0.7)]
    found, _ = claim_of("C3.16").measured(SETTINGS, results)
    assert (found["found_plain"].value, found["found_advised"].value) == (0.1, 0.5)
    assert found["found_gain"].value == 0.4
    assert found["final_advised"].value == 700.0
    each = list(readings(SETTINGS, results))
    assert len(each) == 2 * 2 * 2
    assert each[0][0] == {"loops": 0.1, "experts": "walks", "alpha0": 0.1, "starts": "one", "schedule": "printed"}
    assert each[0][1] == {key: found[key] for key in ("found_plain", "found_advised", "found_gain")}
    cell, numbers = each[3]
    assert (cell["alpha0"], cell["starts"], numbers["found_advised"].value) == (1.0, "any", 0.8)
    cell, numbers = each[4]
    assert (cell["loops"], numbers["found_advised"].value) == (0.4, 0.7)
    plain, advised = rows(SETTINGS, results)
    assert (plain["x"], plain["mean"]) == ([1, 2, 3, 4], [0, 0, 0, 1000])
    np.testing.assert_array_equal(advised["deviation"], 0)
