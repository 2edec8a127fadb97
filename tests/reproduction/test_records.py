"""Records of results: selection, and curves, by hand."""

import pytest

from lifelore.core.errors import NotFoundError
from reproduction.engine.records import curve_of, having, nested, values_of

RESULTS = [
    {
        "run": run,
        "found": [
            {"method": m, "schedule": [e, 1.0], "first": m * 10.0 + e + run, "curve": [run, run + m, 2.0 * run]}
            for m in (1, 2)
            for e in (0.1, 0.5)
        ],
    }
    for run in range(4)
]
RECORDS = nested(RESULTS, "found", ("run",))


def test_values_come_in_the_order_of_the_records():
    assert values_of(RECORDS, "first", method=2, schedule=[0.5, 1.0]).tolist() == [20.5, 21.5, 22.5, 23.5]
    assert values_of(RECORDS, "curve", method=1, schedule=[0.1, 1.0]).shape == (4, 3)
    assert [record["run"] for record in having(RECORDS, method=1)] == [0, 0, 1, 1, 2, 2, 3, 3]


def test_curves_by_hand():
    assert curve_of([[0.0, 1.0], [2.0, 1.04]]) == {"mean": [1.0, 1.0], "deviation": [1.4, 0.0]}
    assert curve_of([[1.04, 2.0]]) == {"mean": [1.0, 2.0], "deviation": [0.0, 0.0]}


def test_what_is_not_there_is_refused():
    with pytest.raises(NotFoundError, match="no result has"):
        values_of(RECORDS, "first", method=3)
