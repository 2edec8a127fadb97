"""The plain twin of Algorithm 7, by hand and beside exact fractions."""

from fractions import Fraction
from math import exp, inf, log, pi

import pytest

from . import naive_reuse as naive

TINY = 1e-14


def logs(*probabilities: float) -> list[float]:
    return [naive.log_of(p) for p in probabilities]


def test_two_signals_by_hand():
    """Prior ½, ½. Likelihoods 0.8, 0.2 and then 0.5, 0.25: 0.8 : 0.2, then 0.4 : 0.05 = 8 : 1."""
    agent = naive.NaiveReuse([0.5, 0.5])
    assert agent.update(logs(0.8, 0.2)) == pytest.approx(log(0.5), abs=TINY)
    assert agent.belief == pytest.approx([0.8, 0.2], abs=TINY)
    assert agent.update(logs(0.5, 0.25)) == pytest.approx(log(0.45), abs=TINY)
    assert agent.belief == pytest.approx([8 / 9, 1 / 9], abs=TINY)
    assert agent.surprise == pytest.approx(-log(0.5) - log(0.45), abs=TINY)


def test_a_hazard_by_hand():
    """After 0.8, 0.2 a tenth is drawn anew from 0.3, 0.7: 0.72 + 0.03 and 0.18 + 0.07."""
    agent = naive.NaiveReuse([0.5, 0.5], naive.hazard(0.1, [0.3, 0.7]))
    agent.update(logs(0.8, 0.2))
    assert agent.belief == pytest.approx([0.75, 0.25], abs=TINY)
    agent.end_episode()
    assert agent.belief == pytest.approx([0.705, 0.295], abs=TINY)


def test_a_matrix_by_hand_and_its_rows_are_the_type_before():
    agent = naive.NaiveReuse([0.5, 0.5], naive.transitions([[0.9, 0.1], [0.0, 1.0]]))
    agent.update(logs(0.8, 0.2))
    assert agent.belief == pytest.approx([0.72, 0.28], abs=TINY)


def test_several_signals_of_an_episode_share_a_single_step():
    together = naive.NaiveReuse([0.5, 0.5], naive.hazard(0.1, [0.5, 0.5]))
    for signal in (logs(0.8, 0.2), logs(0.5, 0.25)):
        together.observe(signal)
    assert together.belief == pytest.approx([8 / 9, 1 / 9], abs=TINY)
    together.end_episode()
    # 0.9 · 8/9 + 0.05
    assert together.belief == pytest.approx([0.85, 0.15], abs=TINY)
    apart = naive.NaiveReuse([0.5, 0.5], naive.hazard(0.1, [0.5, 0.5]))
    apart.update(logs(0.8, 0.2))
    apart.update(logs(0.5, 0.25))
    assert abs(apart.belief[0] - 0.85) > 0.01


def test_an_impossible_signal_leaves_the_belief_to_the_dynamics():
    agent = naive.NaiveReuse([0.8, 0.2], naive.hazard(0.5, [0.5, 0.5]))
    assert agent.observe([-inf, -inf]) == -inf
    assert agent.belief == pytest.approx([0.8, 0.2], abs=TINY)
    assert (agent.unexplained, agent.surprise) == (1, naive.MAX_SURPRISE)
    agent.end_episode()
    assert agent.belief == pytest.approx([0.65, 0.35], abs=TINY)


def test_an_excluded_type_returns_by_a_hazard_alone():
    for step, left in ((naive.static(), 0.0), (naive.hazard(0.2, [0.5, 0.5]), 0.1)):
        agent = naive.NaiveReuse([0.5, 0.5], step)
        agent.update(logs(0.5, 0.0))
        assert agent.belief[1] == pytest.approx(left, abs=TINY)


def test_a_type_far_behind_is_not_lost():
    """Likelihoods whose product is e^-2000 leave the other type with exactly that share."""
    agent = naive.NaiveReuse([0.5, 0.5])
    for _ in range(20):
        agent.update([0.0, -100.0])
    assert agent.log_belief[1] == pytest.approx(-2000.0, abs=1e-11)
    agent.update([-2000.0, 0.0])
    assert agent.belief == pytest.approx([0.5, 0.5], abs=1e-11)


def test_twenty_episodes_agree_with_fractions():
    """Likelihoods are tenths and the hazard is a twentieth, so fractions hold the belief exactly."""
    tenths = [[(3 * t + 7 * k) % 9 + 1 for t in range(3)] for k in range(20)]
    prior, rate = [Fraction(1, 2), Fraction(1, 3), Fraction(1, 6)], Fraction(1, 20)
    agent = naive.NaiveReuse([float(p) for p in prior], naive.hazard(0.05, [float(p) for p in prior]))
    belief = prior
    for row in tenths:
        joint = [b * Fraction(x, 10) for b, x in zip(belief, row, strict=True)]
        belief = [(1 - rate) * j / sum(joint) + rate * p for j, p in zip(joint, prior, strict=True)]
        assert exp(agent.update(logs(*(x / 10 for x in row)))) == pytest.approx(float(sum(joint)), rel=TINY)
        assert agent.belief == pytest.approx([float(b) for b in belief], rel=TINY)


def test_likelihoods_by_hand():
    assert naive.normal_log_density(5.0, 1.0, 2.0) == pytest.approx(-2.0 - log(2.0) - 0.5 * log(2 * pi), abs=TINY)
    # With one degree of freedom it is Cauchy's density, 1 / (π s (1 + z²)).
    assert naive.student_t_log_density(5.0, 1.0, 2.0, 1.0) == pytest.approx(-log(pi * 2 * 5), abs=TINY)
    edges, probs = [0.0, 2.0, 3.0], [0.4, 0.6]
    found = [exp(naive.histogram_log_density(value, edges, probs)) for value in (-1.0, 0.0, 1.9, 2.0, 3.0, 3.1)]
    assert found == pytest.approx([0.0, 0.2, 0.2, 0.6, 0.6, 0.0], abs=TINY)
    table = [[[0.5, 0.5], [1.0, 0.0]], [[0.2, 0.8], [0.1, 0.9]]]
    assert exp(naive.steps_log_probability([(0, 0, 1), (1, 0, 1)], table)) == pytest.approx(0.4, abs=TINY)
    assert naive.steps_log_probability([(0, 1, 1)], table) == -inf
