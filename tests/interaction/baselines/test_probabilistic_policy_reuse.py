"""PRQ against a plain loop on the same random numbers, its special cases."""

import math

import numpy as np
import pytest

from lifelore.core import COLLISION, TERMINAL, InputError, Tables, stream
from lifelore.core.compiled.random_state import next_uniform, random_state
from lifelore.core.learning.q_learning import Schedule, uniform_rows
from lifelore.interaction.baselines.probabilistic_policy_reuse import ProbabilisticPolicyReuse, _draw_policy

N_STATES, N_ACTIONS = 6, 3
ROW_OF = np.array([0, 1, 2, 3, 0, 1], np.int32)


def world(n_outcomes: int, seed: int = 0) -> Tables:
    random = np.random.default_rng(seed)
    shape = (N_STATES, N_ACTIONS, n_outcomes)
    event = random.choice([0, 0, 0, TERMINAL, COLLISION], shape).astype(np.uint8)
    outcome_cum = np.arange(1, n_outcomes + 1) / n_outcomes
    next_state = random.integers(0, N_STATES, shape).astype(np.int32)
    return Tables(
        next_state, random.integers(-3, 4, shape).astype(float), event, outcome_cum, np.arange(3, dtype=np.int32)
    )


def rows_of(tables):
    return uniform_rows(tables)._replace(q_row=ROW_OF)


def library(n_policies: int) -> np.ndarray:
    return np.random.default_rng(7).dirichlet(np.ones(N_ACTIONS), (n_policies, 4))


def plan(n_episodes: int, discount: float = 0.9) -> Schedule:
    return Schedule(np.linspace(0.5, 0.1, n_episodes), np.linspace(0.5, 0.2, n_episodes), 12, discount)


def ran(settings, tables, policies, schedule, seed=3):
    reuser = settings.begin(4, policies, stream(seed, "w"), stream(seed, "o"))
    curve, chosen = settings.learn(tables, rows_of(tables), policies, schedule, reuser)
    return curve, chosen, reuser


def naive(settings, tables, policies, schedule, seed=3):
    """PRQ as Fernandez and Veloso write it, on lists."""
    world_state, own_state = random_state(stream(seed, "w")), random_state(stream(seed, "o"))

    def drawn(cumulative, state):
        return int(np.searchsorted(cumulative, next_uniform(state), side="right"))

    def epsilon_greedy(values, epsilon):
        if epsilon > 0 and next_uniform(own_state) < epsilon:
            return min(int(next_uniform(own_state) * 3), 2)
        tied = [a for a in range(N_ACTIONS) if values[a] == max(values)]
        return tied[0] if len(tied) == 1 else tied[int(next_uniform(own_state) * len(tied))]

    q = [[0.0] * N_ACTIONS for _ in range(4)]
    new = len(policies)
    gains, tau = [[] for _ in range(new + 1)], settings.temperature
    returns, choices = [], []
    for epsilon, alpha in zip(schedule.epsilon, schedule.alpha, strict=True):
        weights = [math.exp(tau / settings.gain_unit * (np.mean(g) if g else 0.0)) for g in gains]
        u = next_uniform(own_state) * sum(weights)
        k = min(int(np.searchsorted(np.cumsum(weights), u, side="right")), new)
        state = int(tables.starts[int(next_uniform(world_state) * len(tables.starts))])
        psi, got, weight = settings.reuse, 0.0, 1.0
        for _ in range(schedule.max_steps):
            row = ROW_OF[state]
            if k < new and next_uniform(own_state) < psi:
                action = drawn(np.cumsum(policies[k][row]), own_state)
            else:
                action = epsilon_greedy(q[row], epsilon if k < new else 0.0)
            outcome = drawn(tables.outcome_cum, world_state) if len(tables.outcome_cum) > 1 else 0
            reward, event = tables.reward[state, action, outcome], tables.event[state, action, outcome]
            following = tables.next_state[state, action, outcome]
            after = 0.0 if event & TERMINAL else max(q[ROW_OF[following]])
            q[row][action] += alpha * (reward + schedule.discount * after - q[row][action])
            got += weight * reward
            weight *= schedule.discount
            psi *= settings.reuse_decay
            state = int(following)
            if event & TERMINAL:
                break
        gains[k].append(got)
        tau += settings.temperature_step
        returns.append(got)
        choices.append(k)
    return returns, choices, q, gains


@pytest.mark.parametrize(("n_outcomes", "unit", "discount"), [(1, 1.0, 0.9), (3, 1.0, 1.0), (2, 20.0, 0.9)])
def test_learning_equals_the_plain_loop(n_outcomes, unit, discount):
    settings = ProbabilisticPolicyReuse(temperature=0.1, gain_unit=unit, reuse=0.9, reuse_decay=0.8)
    tables, policies = world(n_outcomes), library(3)
    curve, chosen, reuser = ran(settings, tables, policies, plan(120, discount))
    returns, choices, q, gains = naive(settings, tables, policies, plan(120, discount))
    assert chosen.tolist() == choices
    assert len(set(choices)) > 2
    assert curve.returns == pytest.approx(returns, abs=1e-12)
    assert reuser.q == pytest.approx(np.array(q), abs=1e-12)
    assert reuser.uses.tolist() == [len(g) for g in gains]
    assert reuser.gain == pytest.approx([np.mean(g) if g else 0.0 for g in gains])
    assert reuser.temperature[0] == pytest.approx(0.1 + 120 * 0.05)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("temperature", -1.0),
        ("temperature_step", float("nan")),
        ("reuse", 1.1),
        ("reuse_decay", -0.1),
        ("gain_unit", 0.0),
    ],
)
def test_settings_that_cannot_be(name, value):
    with pytest.raises(InputError, match=f"^{name} must"):
        ProbabilisticPolicyReuse(**{name: value})


def test_a_library_over_other_rows_is_refused():
    with pytest.raises(InputError, match="library must have 5 rows"):
        ProbabilisticPolicyReuse().begin(5, library(2), stream(0, "w"), stream(0, "o"))
    with pytest.raises(InputError, match="library must hold probabilities"):
        ProbabilisticPolicyReuse().begin(4, 2 * library(2), stream(0, "w"), stream(0, "o"))


@pytest.mark.parametrize(("unit", "share"), [(1.0, math.exp(7) / (math.exp(7) + 4)), (140.0, 0.2081)])
def test_the_unit_of_returns_decides_how_greedy_the_temperature_is(unit, share):
    # One episode of 140 behind one of five policies, and τ = 0.05: 99.6 % against 20.8 %.
    random, gain = random_state(stream(1, "unit")), np.array([0.0, 140.0, 0.0, 0.0, 0.0])
    drawn = [_draw_policy(gain, 0.05 / unit, random) for _ in range(40_000)]
    # Five standard errors, at most 0.0025 each.
    assert abs(np.mean(np.array(drawn) == 1) - share) < 0.0125
