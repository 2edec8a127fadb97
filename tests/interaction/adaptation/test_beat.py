"""BEAT against Algorithm 9 as printed, from the types' MDPs; its schedules by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.adaptation.beat import EPSILONS, Beat, rule_at
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection.epsilon_greedy import EpsilonGreedy
from lifelore.interaction.signals.transition_signal import TransitionSignal

N_TYPES, N_SETS, N_STATES = 4, 3, 5


def library(seed=0, n_actions=2):
    """Types × action sets with random transitions over five states."""
    generator = np.random.default_rng(seed)
    probs = generator.dirichlet(np.ones(N_STATES), (N_TYPES, N_SETS, N_STATES, n_actions))
    value = generator.normal(size=(N_TYPES, N_SETS))
    return PolicyLibrary.from_means(value, np.ones_like(value), signal=TransitionSignal(probs)), probs, value


def move(generator, probs, type_, policy, state):
    action = int(generator.integers(probs.shape[3]))
    return state, action, int(generator.choice(N_STATES, p=probs[type_, policy, state, action]))


@pytest.mark.slow
def test_logs_hold_what_products_lose():
    lib, probs, _ = library()
    beat, world, state, product = Beat(lib), np.random.default_rng(2), 0, np.ones(N_TYPES)
    for _ in range(3000):
        triple = move(world, probs, 1, 0, state)
        beat.update(0, [triple])
        product *= probs[:, 0, triple[0], triple[1], triple[2]]
        state = triple[2]
    assert (product == 0).all()  # the printed belief
    assert beat.belief.sum() == pytest.approx(1)
    assert beat.belief.argmax() == 1
    assert beat.log_belief.min() < -745  # less than any float


def test_printed_schedules_by_hand():
    assert [rule_at("1/n", step).epsilon for step in range(3)] == [1, 1 / 2, 1 / 3]
    by_episode = [rule_at("by episode", 7, episode).epsilon for episode in range(7)]
    assert by_episode == pytest.approx([0.5, 0.4, 0.3, 0.2, 0.1, 0, 0])
    # Σ 1/n diverges as Algorithm 9 asks; the experiments' schedule sums to 1.5 steps' worth an episode and stops.
    assert sum(EPSILONS["1/n"](step, 0) for step in range(10_000)) > 9
    assert sum(EPSILONS["by episode"](0, episode) for episode in range(10_000)) == pytest.approx(1.5)
    assert rule_at(0.2, 5, 5) == EpsilonGreedy(0.2)


def test_bad_input():
    lib, _, _ = library()
    for arguments, rule in (
        ({"epsilon": 1.5}, "epsilon must lie in"),
        ({"epsilon": "never"}, "epsilon must be a number or one of 1/n, by episode"),
        ({"prior": [0.5, 0.5]}, "prior must be"),
    ):
        with pytest.raises(InputError, match=rule):
            Beat(lib, **arguments)
    beat = Beat(lib)
    with pytest.raises(InputError, match="each step must be below"):
        beat.update(0, [(0, 0, 99)])
    with pytest.raises(NotFoundError):
        beat.update("none such", [(0, 0, 1)])
    assert beat.step == 0
    assert beat.belief == pytest.approx(np.full(N_TYPES, 1 / N_TYPES))


# ---- from the types' MDPs ----------------------------------------------------------------------------


def naive_value(transitions, rewards, terminal, actions, discount) -> np.ndarray:
    """Line 2 of Alg. 9: the value of each state under the best policy that takes `actions` alone."""
    value = np.zeros(len(transitions))
    for _ in range(500):
        value = np.array(
            [
                0.0 if s in terminal
                else max(
                    sum(p * (rewards[t] + discount * value[t]) for t, p in enumerate(transitions[s, a]))
                    for a in actions
                )
                for s in range(len(transitions))
            ]
        )  # fmt: skip
    return value


def test_values_are_computed_and_decisions_are_those_of_the_printed_algorithm():
    random = np.random.default_rng(4)
    transitions, rewards = random.dirichlet(np.ones(5), (3, 5, 4)), random.normal(size=5)
    sets = {"fine": [0, 1], "coarse": [2, 3]}
    beat = Beat.from_tasks(transitions, rewards, sets, 0.8, terminal=[4], epsilon=0.0)
    value = np.array(
        [
            [naive_value(each, rewards, [4], chosen, 0.8)[:4].mean() for chosen in sets.values()]
            for each in transitions
        ]
    )
    assert beat.library.performance.mean == pytest.approx(value)
    assert beat.library.policies == ("fine", "coarse")
    belief, chosen = np.full(3, 1 / 3), set()
    for _ in range(12):
        z = int(np.argmax(belief @ value))  # Eq. 4.8, 4.9
        assert beat.select() == z
        s, a, t = random.integers(4), random.integers(4), random.integers(5)
        beat.update(z, (s, a, t))
        belief *= transitions[:, s, a, t]  # line 6
        assert beat.belief == pytest.approx(belief / belief.sum())
        chosen.add(z)
    assert chosen == {0, 1}


def test_from_tasks_starts_explore_as_printed_and_rules():
    transitions = np.random.default_rng(0).dirichlet(np.ones(3), (2, 3, 2))
    beat = Beat.from_tasks(transitions, np.arange(3.0), {"a": [0], "b": [1]}, 0.9, starts=[1], prior=[0.9, 0.1])
    assert beat.rule == EpsilonGreedy(1.0)  # 1/n at the first step
    assert beat.belief.tolist() == pytest.approx([0.9, 0.1])
    assert beat.library.performance.mean[1, 0] == pytest.approx(
        naive_value(transitions[1], np.arange(3.0), [], [0], 0.9)[1]
    )
    for arguments, message in (
        (([transitions[0], transitions[0][:, :1]], np.arange(3.0), {"a": [0]}, 0.9), "same states and actions"),
        ((transitions, np.arange(3.0), {"a": []}, 0.9), "sets of at least one action"),
        ((transitions, np.arange(3.0), {"a": [2]}, 0.9), "action set 'a' must be whole numbers from 0 to 1"),
        ((transitions, np.arange(3.0), [[0], [1]], 0.9), "action_sets must map names to actions, got list"),
        ((transitions, np.arange(3.0), {}, 0.9), "sets of at least one action"),
    ):
        with pytest.raises(InputError, match=message):
            Beat.from_tasks(*arguments)
