"""When regret ended, by hand."""

import pytest

from reproduction.chapter4.c4_05_selection_rules.run import convergence
from reproduction.chapter4.reuse.rules import RULES, in_form


def made_up():
    """Two groups of two tasks; PI as printed is stuck."""
    found = {
        name: {"groups": 2, "ended": [4, 6, 4, 6], "sums": [300.0, 310.0, 320.0, 330.0], "late": [0.0] * 4}
        for name in RULES
    }
    found["EI"] |= {"sums": [100.0, 110.0, 120.0, 130.0], "ended": [3, 3, 3, 3]}
    found["KG"] |= {"sums": [150.0, 160.0, 180.0, 190.0]}
    found["PI, printed"] |= {"ended": [51] * 4, "late": [90.0, 80.0, 70.0, 60.0]}
    return found


def test_statements_by_hand():
    found = convergence(made_up(), "standard")
    assert (found["ended_EI"].value, found["ended_BE"].value) == (3, 5)
    assert found["late_PI"].value == 0
    # The next best rule is KG: 50, 50, 60 and 60 more.
    assert found["next_minus_EI"].value == pytest.approx(55)


def test_pi_as_printed_is_a_reading_of_its_own():
    found = convergence(made_up(), "PI as printed")
    assert found["late_PI"].value == 75
    assert found["next_minus_EI"].value == pytest.approx(55)
    assert in_form("EI", "PI as printed") == "EI"
    assert in_form("EI", "all as printed") == "EI, printed"
    assert in_form("sampling", "all as printed") == "sampling"
