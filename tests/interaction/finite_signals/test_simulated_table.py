"""Signals that were drawn as an alphabet: information beside the exact one; letters that are few or certain."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction import Greedy, InformationDirected, LikelihoodSignal, PolicyLibrary
from lifelore.interaction.finite_signals.simulated_table import simulated_table
from lifelore.interaction.selection import default_rule
from lifelore.interaction.selection.information import mutual_information

PROBS = np.random.default_rng(0).dirichlet(np.ones(4), (3, 5))


def drawn(generator, type_, policy):
    return int(generator.choice(4, p=PROBS[type_, policy]))


def in_plain_python(letters, likelihood, n):
    """P(letter | type): F over the sum of all types' F, scaled to sum to 1."""
    rows = [[likelihood(t, s) / sum(likelihood(u, s) for u in range(3)) for s in letters] for t in range(3)]
    return [[p / sum(row) for p in row] for row in rows]


def test_a_table_is_that_of_importance_sampling():
    letters = []
    table = simulated_table(
        lambda policy, signal: np.log(PROBS[:, policy, signal]),
        lambda generator, type_, policy: letters.append(drawn(generator, type_, policy)) or letters[-1],
        3, 5, 8,
    )  # fmt: skip
    for policy in range(5):
        own = letters[24 * policy : 24 * (policy + 1)]
        expected = in_plain_python(own, lambda t, s, policy=policy: PROBS[t, policy, s], 8)
        assert table.probs[:, policy] == pytest.approx(np.array(expected))


def test_certain_and_impossible_signals():
    """A signal that names the type tells the whole entropy; one that no type can have tells nothing."""
    with np.errstate(divide="ignore"):
        eye = np.log(np.eye(3))
    named = simulated_table(lambda policy, signal: eye[signal], lambda generator, type_, policy: type_, 3, 1, 4)
    assert mutual_information(np.full(3, 1 / 3), named) == pytest.approx([np.log(3)])
    never = simulated_table(lambda policy, signal: np.full(3, -np.inf), lambda *_: 0, 3, 1, 4)
    assert mutual_information(np.full(3, 1 / 3), never) == pytest.approx([0.0], abs=1e-12)


def own_signal(sample=None):
    return LikelihoodSignal(lambda policy, signal: np.log(PROBS[:, policy, signal]), 3, 5, sample)


def test_rules_that_look_ahead_use_signals_that_are_drawn_or_stored():
    """The default rule too; without samples it is greedy."""
    mean = np.random.default_rng(1).normal(size=(3, 5))
    random = np.random.default_rng(2)
    stored = [[[drawn(random, type_, policy) for _ in range(6)] for policy in range(5)] for type_ in range(3)]
    for sample in (drawn, stored):
        library = PolicyLibrary.from_means(mean, 1.0, signal=own_signal(sample))
        assert library.has_table
        assert default_rule(library) == InformationDirected()
        part = library.signal.take([2, 0], [4, 1, 0])  # pyright: ignore[reportAttributeAccessIssue]
        assert part.sample(np.random.default_rng(0), 0, 1) in range(4)
        assert part.log_likelihood(1, 3) == pytest.approx(np.log(PROBS[[2, 0], 1, 3]))
    assert default_rule(PolicyLibrary.from_means(mean, 1.0, signal=own_signal())) == Greedy()
    with pytest.raises(InputError, match="sample must hold signals of each type and policy, none of 1 and 0"):
        PolicyLibrary.from_means(mean, 1.0, signal=own_signal([[[0]] * 5, [[]] * 5, [[0]] * 5])).table()


class Own:
    """A signal model with nothing but `log_likelihood`, and `sample`."""

    def log_likelihood(self, policy, signal):
        return np.log(PROBS[:, policy, signal])

    sample = staticmethod(drawn)


def test_an_own_class_needs_a_likelihood_and_may_draw():
    library = PolicyLibrary.from_means(np.eye(3, 5), 1.0, signal=Own())
    assert library.table(8).probs == pytest.approx(
        PolicyLibrary.from_means(np.eye(3, 5), 1.0, signal=own_signal(drawn)).table(8).probs
    )
