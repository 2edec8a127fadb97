"""Every model's log likelihoods of many signals are those of single signals; impossible signals are refused."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.batch_likelihood import batch_likelihood
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.outcome_kinds import KINDS, outcome_kind
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.joint_signal import JointSignal
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal
from lifelore.interaction.signals.return_signal import ReturnSignal

SAMPLES = np.array([[[1.0, 2.0, 2.0], [0.0, 0.0, 1.0]], [[2.0, 2.0, 1.0], [1.0, 1.0, 0.0]]])
WORDS = CategorySignal([[[0.9, 0.1], [0.5, 0.5]], [[0.2, 0.8], [1.0, 0.0]]])


class Doubled(GaussianOutcomes):
    """Gaussian outcomes with densities of its own."""

    def log_density(self, policy, value):
        return 2 * super().log_density(policy, value)

    def log_densities(self, policies, values):
        return 2 * super().log_densities(policies, values)


class OwnReturn(ReturnSignal):
    """Returns with log likelihoods of its own."""

    def log_likelihood(self, policy, signal):
        return 3 * super().log_likelihood(policy, signal)

    def log_likelihoods(self, policies, signals):
        return 3 * super().log_likelihoods(policies, signals)


def returns(kind: str):
    settings = {"edges": np.linspace(-0.5, 2.5, 4)} if kind == "histogram" else {}
    return ReturnSignal(outcome_kind(kind).from_samples(SAMPLES, **settings))


MODELS = {kind: (returns(kind), [1.0, 2.0, 0.0, 1.0]) for kind in KINDS} | {
    "category": (WORDS, [0, 1, 1, 0]),
    "joint": (JointSignal([WORDS, WORDS]), [(0, 1), (1, 1), (0, 0), (1, 0)]),
    "own": (LikelihoodSignal(lambda policy, x: [policy - x, -np.inf], 2), [1.0, 2.0, 0.0, 1.0]),
    "own densities": (ReturnSignal(Doubled([[0.0, 1.0], [2.0, 1.0]], 1.0)), [1.0, 2.0, 0.0, 1.0]),
    "own log likelihoods": (OwnReturn(GaussianOutcomes([[0.0, 1.0], [2.0, 1.0]], 1.0)), [1.0, 2.0, 0.0, 1.0]),
}


@pytest.mark.parametrize("name", MODELS)
def test_a_batch_has_the_bits_of_single_signals(name):
    model, signals = MODELS[name]
    policies = np.array([0, 1, 1, 0])
    likelihood = batch_likelihood(model)
    found = np.empty((4, 2))
    likelihood.write(policies, likelihood.checked(signals), found)
    for row, policy, signal in zip(found, policies.tolist(), signals, strict=True):
        assert row.tolist() == np.asarray(model.log_likelihood(policy, signal)).tolist()


def test_only_normals_without_densities_of_their_own_give_their_arrays():
    assert batch_likelihood(returns("gaussian")).normals is not None
    for name in MODELS:
        if name != "gaussian":
            assert batch_likelihood(MODELS[name][0]).normals is None, name


def test_normals_see_what_the_model_learns():
    outcomes = GaussianOutcomes([[0.0], [1.0]], 1.0, count=3)
    likelihood, found = batch_likelihood(ReturnSignal(outcomes)), np.empty((1, 2))
    outcomes.observe(0, 0, 50.0)
    likelihood.write(np.array([0]), np.array([2.0]), found)
    assert found[0].tolist() == outcomes.log_density(0, 2.0).tolist()


@pytest.mark.parametrize("name", [*KINDS, "own log likelihoods"])
def test_returns_that_are_not_finite_are_refused(name):
    for bad in (np.nan, np.inf, 1e200):
        with pytest.raises(InputError, match="signals must be finite numbers"):
            batch_likelihood(MODELS[name][0]).checked([1.0, bad])


def test_categories_outside_the_table_are_refused():
    for bad in ([2], [-1], [0.5]):
        with pytest.raises(InputError, match="category numbers 0 to 1"):
            batch_likelihood(WORDS).checked(bad)


@pytest.mark.parametrize("answer", [np.nan, np.inf])
def test_answers_that_are_no_log_likelihoods_are_refused(answer):
    class Single:
        def log_likelihood(self, policy, signal):
            return np.array([answer, 0.0])

    class Many:
        def log_likelihoods(self, policies, signals):
            return np.full((len(policies), 2), answer)

    for model in (Single(), Many()):
        with pytest.raises(InputError, match="gave NaN or infinity"):
            batch_likelihood(model).write(np.array([0]), np.array([1.0]), np.empty((1, 2)))
