"""The plain twins of the selection rules, by hand on one case of two types and three policies."""

from math import inf, log, pi, sqrt

import pytest

from . import naive_rules as naive

MEAN = [[10.0, 6.0, 0.0], [0.0, 6.0, 8.0]]
DEVIATION = [[2.0, 2.0, 2.0], [2.0, 2.0, 2.0]]
FLAT = [0.5, 0.5]
"""Utilities 5, 6 and 4."""
TELLS, SILENT = [[1.0, 0.0], [0.0, 1.0]], [[0.5, 0.5], [0.5, 0.5]]
LAWS = [TELLS, SILENT, SILENT]
"""Policy 0 tells the type, the others tell nothing."""
NORMAL_EXCESS = 1 / sqrt(2 * pi)
"""E[max(Z, 0)] of a standard normal Z."""


def test_utilities_and_the_rules_that_read_them_alone():
    assert naive.utilities(FLAT, MEAN) == [5.0, 6.0, 4.0]
    assert naive.tied_shares(naive.utilities(FLAT, MEAN)) == [0.0, 1.0, 0.0]


def test_equals_share_the_choice():
    assert naive.tied_shares([1.0, 3.0, 3.0 - 1e-10]) == [0.0, 0.5, 0.5]
    assert naive.tied_shares([-inf, -inf]) == [0.5, 0.5]
    assert naive.tied_shares([-inf, 0.0]) == [0.0, 1.0]
    # Of scores up to 1, a difference of 1e-16 is rounding, even where the best score is 0.
    assert naive.tied_shares([0.0, -1e-16, -1.0]) == [0.5, 0.5, 0.0]


def test_improvement_of_the_mean_pay():
    """Above 6: policy 0 by 4 on half of the types, policy 2 by 2 on the other half."""
    assert naive.mean_improvement(FLAT, MEAN) == pytest.approx([2.0, 0.0, 1.0])
    # Of a single known type nothing improves, and the utilities decide.
    assert naive.mean_improvement([1.0, 0.0], MEAN) == [10.0, 6.0, 0.0]
    # A mean known to ± 3 around the best utility exceeds it by 3 E[max(Z, 0)].
    uncertain = [[0.0, 3.0, 0.0], [0.0, 3.0, 0.0]]
    assert naive.mean_improvement(FLAT, MEAN, uncertain)[1] == pytest.approx(3 * NORMAL_EXCESS)


def test_improvement_of_an_outcome():
    """Policy 1: 2 E[max(Z, 0)]. Policy 0: 4 + 2 E[max(Z − 2, 0)] on a type and 2 E[max(Z − 3, 0)] on the other."""
    found = naive.expected_improvement(FLAT, MEAN, DEVIATION)
    assert found[1] == pytest.approx(2 * NORMAL_EXCESS)
    # E[max(Z − 2, 0)] = 0.008491 and E[max(Z − 3, 0)] = 0.000382, from tables of the unit normal loss.
    assert found[0] == pytest.approx(0.5 * (4 + 2 * 0.008491) + 0.5 * 2 * 0.000382, abs=2e-6)
    printed = naive.probability_above(FLAT, MEAN, DEVIATION, 6.0)
    assert printed == pytest.approx(
        [0.5 * 0.977250 + 0.5 * 0.001350, 0.5, 0.5 * 0.001350 + 0.5 * 0.841345], abs=1e-6
    )


def test_probability_of_improvement():
    """On the best mean, 10, half of the first type's outcomes improve; the density printed is 1 / (2 √2π)."""
    assert naive.probability_above(FLAT, MEAN, DEVIATION, 10.0)[0] == pytest.approx(0.25, abs=1e-6)
    assert naive.density_at([1.0, 0.0], MEAN, DEVIATION, 10.0)[0] == pytest.approx(1 / (2 * sqrt(2 * pi)))


def test_the_entropy_to_expect():
    assert naive.entropy(FLAT) == pytest.approx(log(2))
    assert naive.expected_entropy(FLAT, LAWS) == pytest.approx([0.0, log(2), log(2)])
    scores = naive.belief_entropy(FLAT, MEAN, LAWS, 10.0)
    assert scores == pytest.approx([5.0, 6.0 - 10 * log(2), 4.0 - 10 * log(2)])
    # As printed, each type is sure of itself, and the sum is 2.
    assert naive.printed_posterior(FLAT, TELLS) == [1.0, 1.0]


def test_the_gain_of_knowledge():
    """Once the type is known the best pays are 10 and 8, 9 on average, 3 above the best utility now."""
    assert naive.knowledge_gain(FLAT, MEAN, LAWS) == pytest.approx([3.0, 0.0, 0.0])
    assert naive.printed_gain(FLAT, MEAN, LAWS) == pytest.approx([0.0, 0.0, 0.0])
    # The second policy alone can be chosen next: there is nothing to gain.
    assert naive.knowledge_gain(FLAT, MEAN, LAWS, [1]) == pytest.approx([0.0, 0.0, 0.0])


def test_the_value_of_perfect_information():
    """Policy 0's pay once known: 10 or, of policy 1, 6. Policy 2: 6 or 8. Policy 1 is best whatever its pay."""
    assert naive.perfect_gain(FLAT, MEAN) == pytest.approx([2.0, 0.0, 1.0])
    assert naive.perfect_gain([1.0], [[5.0]]) == [0.0]
    # Both policies pay 6 ± 3 and 6: either's pay once known gains 3 E[max(Z, 0)] or nothing.
    assert naive.perfect_gain([1.0], [[6.0, 6.0]], [[3.0, 0.0]]) == pytest.approx([3 * NORMAL_EXCESS, 0.0])


def test_information_directed():
    """Regret 4, 3, 5 of the best pay to expect, 9; policy 0 tells log 2 nats."""
    assert naive.information_ratio(FLAT, MEAN, LAWS) == pytest.approx([16 / log(2), inf, inf])
