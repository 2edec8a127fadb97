"""The twin of Algorithm 7's two steps, by hand and beside exact fractions."""

from math import exp, inf, log, pi

import pytest

from . import naive_reuse as naive

TINY = 1e-14


def logs(*probabilities: float) -> list[float]:
    return [naive.log_of(p) for p in probabilities]


def test_two_signals_by_hand():
    """Prior ½, ½. Likelihoods 0.8, 0.2 and then 0.5, 0.25: 0.8 : 0.2, then 0.4 : 0.05 = 8 : 1."""
    belief, evidence = naive.bayes(logs(0.5, 0.5), logs(0.8, 0.2))
    assert evidence == pytest.approx(log(0.5), abs=TINY)
    belief, evidence = naive.bayes(belief, logs(0.5, 0.25))
    assert (belief, evidence) == (pytest.approx(logs(8 / 9, 1 / 9), abs=TINY), pytest.approx(log(0.45), abs=TINY))
    assert naive.bayes(belief, [-inf, -inf]) == (belief, -inf)


def test_steps_by_hand():
    """A tenth is drawn anew from 0.3, 0.7; rows of a matrix are the type before."""
    belief = logs(0.8, 0.2)
    assert naive.hazard(0.1, [0.3, 0.7])(belief) == pytest.approx(logs(0.75, 0.25), abs=TINY)
    assert naive.hazard(0.2, [0.5, 0.5])(logs(1.0, 0.0)) == pytest.approx(logs(0.9, 0.1), abs=TINY)
    assert naive.transitions([[0.9, 0.1], [0.0, 1.0]])(belief) == pytest.approx(logs(0.72, 0.28), abs=TINY)


def test_likelihoods_by_hand():
    assert naive.normal_log_density(5.0, 1.0, 2.0) == pytest.approx(-2.0 - log(2.0) - 0.5 * log(2 * pi), abs=TINY)
    table = [[[0.5, 0.5], [1.0, 0.0]], [[0.2, 0.8], [0.1, 0.9]]]
    assert exp(naive.steps_log_probability([(0, 0, 1), (1, 0, 1)], table)) == pytest.approx(0.4, abs=TINY)
    assert naive.steps_log_probability([(0, 1, 1)], table) == -inf
