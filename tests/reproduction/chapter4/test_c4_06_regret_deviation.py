"""Deviations and their pattern by hand, and what the printed table can be."""

import numpy as np
import pytest

from lifelore.domains.surveillance.surveillance import NOISES
from reproduction.chapter4.c4_06_regret_deviation.run import PRINTED, deviations, pattern
from reproduction.chapter4.reuse.rules import RULES, STANDARD


def of_groups(*by_episode):
    """A result of three groups of two tasks with these deviations after each episode, 1 % apart."""
    one = np.array(by_episode) / 2**0.5
    values = [[sign * group * one for sign in (1, -1)] for group in (0.99, 1.0, 1.01)]
    return {"groups": 3, "after": {"expected": np.reshape(values, (6, 4)).tolist()}}


def test_deviations_by_hand():
    result = {"groups": 2, "after": {"expected": [[0.0, 3.0], [4.0, 3.0], [1.0, 0.0], [1.0, 2.0]]}}
    assert deviations(result, "expected") == pytest.approx(np.array([[8**0.5, 0.0], [0.0, 2**0.5]]))


def test_pattern_by_hand():
    results = {name: of_groups(80, 60, 20, 10) for name in RULES}
    results |= {"ε-greedy": of_groups(70, 90, 80, 85), "EI": of_groups(30, 30, 20, 15)}
    results["PI, printed"] = of_groups(16, 62, 72, 100)
    found = pattern(results, "standard", "expected")
    assert found["fall_sampling"].value == pytest.approx(70)
    assert found["fall_EI"].value == pytest.approx(15)
    # Of the four EI varies most.
    assert found["more_eps_greedy"].value == pytest.approx(70)
    assert found["more_PI"].value == pytest.approx(-5)
    assert pattern(results, "PI as printed", "expected")["more_PI"].value == pytest.approx(85)


def test_the_printed_table_agrees_with_itself():
    results = {name: of_groups(*PRINTED[name.partition(",")[0]]) for name in RULES}
    assert pattern(results, "standard", "expected")["agree"].value == 1
    results["EI"] = of_groups(1, 1, 1, 1)
    assert pattern(results, "standard", "expected")["agree"].value == pytest.approx(20 / 24)
    assert set(PRINTED) == set(STANDARD)


def test_only_the_size_of_a_difference_with_deviation_20_can_leave_what_is_printed():
    """Erratum: what has converged varies by noise alone; print has 10 to 19 after 20 and 50 episodes."""
    late = [n for rule in ("sampling", "BE", "EI") for n in PRINTED[rule][2:]]
    luck = np.random.default_rng(0).standard_normal((4000, 2, 10))
    sizes = {}
    for noise, deviation in NOISES.items():
        differences = deviation * (luck[:, 0] - luck[:, 1])
        sizes[noise] = np.quantile(np.abs(differences).std(axis=1, ddof=1), [0.025, 0.975])
    low, high = sizes["deviation 20"]
    assert low <= min(late)
    assert max(late) <= high
    assert sizes["variance 20"][1] < min(late)
    # With its sign the difference varies by 20 √2, and groups of ten leave less than 15 seldom.
    signed = np.quantile((20 * (luck[:, 0] - luck[:, 1])).std(axis=1, ddof=1), 0.025)
    assert sum(n < signed for n in late) >= 3
