"""The table of results: selection, pairing and estimates, against the same done by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.metrics import difference_estimate, mean_estimate, ratio_estimate
from reproduction.engine.results_table import ResultsTable, computed_once, curve_of, tally

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


def test_curve_has_a_t_interval_worked_by_hand():
    found = curve_of([[0.0, 1.0], [2.0, 1.0]])
    assert found["mean"] == [1.0, 1.0]
    assert found["deviation"] == pytest.approx([np.sqrt(2), 0.0])
    # The 97.5 % point of t with one degree of freedom is 12.706; the standard error is 1.
    assert found["high"] == pytest.approx([1 + 12.7062, 1.0], rel=1e-5)
    assert curve_of([[1.0, 2.0]])["low"] == [1.0, 2.0]
    assert curve_of([[1.04, 2.0]], digits=1, parts=("mean",)) == {"mean": [1.0, 2.0]}


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


def test_work_is_computed_once_for_the_same_settings_and_results():
    asked = []

    @computed_once
    def work(settings, results):
        asked.append(settings["n"])
        return settings["n"] + len(results)

    assert [work({"n": 1}, [{}]), work({"n": 1}, [{}]), work({"n": 2}, [{}]), work({"n": 2}, [{"x": 0}])] == [
        2,
        2,
        3,
        3,
    ]
    assert asked == [1, 2, 2]
