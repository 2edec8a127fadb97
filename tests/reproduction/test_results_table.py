"""The table of results: selection, pairing and estimates, against the same done by hand."""

import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.metrics import difference_estimate, mean_estimate, ratio_estimate
from reproduction.engine.results_table import ResultsTable, curve_of, tally

KEYS = ("method", "schedule", "run")
RECORDS = [
    {"method": m, "schedule": [e, 1.0], "run": r, "first": m * 10.0 + e + r, "curve": [r, r + m, 2.0 * r]}
    for m in (1, 2)
    for e in (0.1, 0.5)
    for r in range(4)
]
TABLE = ResultsTable(RECORDS, KEYS)


def test_values_come_in_the_order_of_the_records():
    assert TABLE.values("first", method=2, schedule=[0.5, 1.0]).tolist() == [20.5, 21.5, 22.5, 23.5]
    assert TABLE.values("curve", method=1, schedule=(0.1, 1.0)).shape == (4, 3)
    assert len(TABLE.select(method=1)) == 8


def test_estimates_are_those_of_the_values():
    one, other = ({"method": m, "schedule": [0.1, 1.0]} for m in (1, 2))
    first, second = TABLE.values("first", **one), TABLE.values("first", **other)
    assert TABLE.mean("first", **one) == mean_estimate(first)
    assert TABLE.difference("first", one, other) == difference_estimate(first, second)
    assert TABLE.ratio("first", one, other) == ratio_estimate(first, second)


def test_curves_by_hand():
    assert curve_of([[0.0, 1.0], [2.0, 1.04]]) == {"mean": [1.0, 1.0], "deviation": [1.4, 0.0]}
    assert curve_of([[1.04, 2.0]]) == {"mean": [1.0, 2.0], "deviation": [0.0, 0.0]}


def test_what_is_not_there_is_refused():
    with pytest.raises(NotFoundError, match="no result has"):
        TABLE.values("first", method=3)
    with pytest.raises(InputError, match="must name keys among method, schedule, run"):
        TABLE.values("first", agent=1)
    with pytest.raises(InputError, match="agree in number, got 8 and 4"):
        TABLE.paired("first", {"method": 1}, {"method": 2, "schedule": [0.1, 1.0]})


def test_a_tally_counts_equal_records_in_the_order_of_their_values():
    records = [{"kind": "b", "points": [1, 2]}, {"kind": "a", "points": [1]}, {"kind": "b", "points": [1, 2]}]
    assert tally(records, "n") == [{"kind": "a", "points": [1], "n": 1}, {"kind": "b", "points": [1, 2], "n": 2}]
    real = [{"kind": "real", "loops": None, "holes": k} for k in (1, 0)]
    assert [row["holes"] for row in tally(real, "n")] == [0, 1]
