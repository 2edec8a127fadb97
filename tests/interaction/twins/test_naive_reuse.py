"""The twin of Algorithm 7's two steps, by hand and beside exact fractions."""

from fractions import Fraction
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


def test_a_type_far_behind_is_not_lost():
    """Likelihoods whose product is e^-2000 leave the other type with exactly that share."""
    belief = logs(0.5, 0.5)
    for _ in range(20):
        belief, _ = naive.bayes(belief, [0.0, -100.0])
    assert belief[1] == pytest.approx(-2000.0, abs=1e-11)
    assert naive.bayes(belief, [-2000.0, 0.0])[0] == pytest.approx(logs(0.5, 0.5), abs=1e-11)


def test_twenty_episodes_agree_with_fractions():
    """Likelihoods are tenths and the hazard is a twentieth, so fractions hold the belief exactly."""
    tenths = [[(3 * t + 7 * k) % 9 + 1 for t in range(3)] for k in range(20)]
    prior, rate = [Fraction(1, 2), Fraction(1, 3), Fraction(1, 6)], Fraction(1, 20)
    step, found, belief = naive.hazard(0.05, [float(p) for p in prior]), logs(*map(float, prior)), prior
    for row in tenths:
        joint = [b * Fraction(x, 10) for b, x in zip(belief, row, strict=True)]
        belief = [(1 - rate) * j / sum(joint) + rate * p for j, p in zip(joint, prior, strict=True)]
        found, evidence = naive.bayes(found, logs(*(x / 10 for x in row)))
        found = step(found)
        assert exp(evidence) == pytest.approx(float(sum(joint)), rel=TINY)
        assert [exp(b) for b in found] == pytest.approx([float(b) for b in belief], rel=TINY)


def test_likelihoods_by_hand():
    assert naive.normal_log_density(5.0, 1.0, 2.0) == pytest.approx(-2.0 - log(2.0) - 0.5 * log(2 * pi), abs=TINY)
    table = [[[0.5, 0.5], [1.0, 0.0]], [[0.2, 0.8], [0.1, 0.9]]]
    assert exp(naive.steps_log_probability([(0, 0, 1), (1, 0, 1)], table)) == pytest.approx(0.4, abs=TINY)
    assert naive.steps_log_probability([(0, 1, 1)], table) == -inf
