"""The probability that no known type fits: by hand, in rows, and beside a library that learns."""

import numpy as np
import pytest
from scipy.stats import norm

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.novelty.unknown_evidence import unknown_evidence
from lifelore.interaction.selection import BeliefSampling
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal

TRUE = np.array([[200.0, 80, 120], [60, 210, 110], [90, 100, 220]])


def learnt(n: int = 10, **options) -> PolicyLibrary:
    return PolicyLibrary.from_samples(np.random.default_rng(0).normal(TRUE[..., None], 20, (3, 3, n)), **options)


def test_one_signal_by_hand():
    library = PolicyLibrary.from_means([[10.0], [0.0]], 2.0)
    agent = BayesianPolicyReuse(library, novelty=0.2)
    assert agent.novelty.probability == pytest.approx(0.2, abs=1e-15)
    agent.update(0, 6.0)
    # Pooled mean 5, variance 4, spread over types 25: the mean counts as 4 / 25 outcomes.
    broad = norm.logpdf(6.0, 5.0, np.sqrt(4 * (1 + 25 / 4)))
    known = np.log(0.5 * norm.pdf(6, 10, 2) + 0.5 * norm.pdf(6, 0, 2))
    assert agent.novelty.log_odds == pytest.approx(broad - known, abs=1e-12)
    odds = np.exp(broad - known) * 0.2 / 0.8
    assert agent.novelty.probability == pytest.approx(odds / (1 + odds), rel=1e-12)


@pytest.mark.parametrize("models", ["uncertain", "plug-in"])
@pytest.mark.parametrize("kind", ["outcomes", "categories"])
def test_rows_are_single_tasks(kind, models):
    random = np.random.default_rng(1)
    signal = None if kind == "outcomes" else CategorySignal(random.dirichlet(np.ones(4), (3, 3)), count=12)
    library = learnt(signal=signal)
    many, alone = (
        unknown_evidence(library, 6, models=models),
        [unknown_evidence(library, models=models) for _ in range(6)],
    )
    for _ in range(9):
        policies = random.integers(0, 3, 6)
        signals = random.normal(140, 30, 6) if signal is None else random.integers(0, 4, 6)
        many.observe(np.arange(6), policies, signals)
        many.end_episode(np.arange(6))
        for row, one in enumerate(alone):
            one.observe(0, int(policies[row]), signals[row].item())
            one.end_episode(0)
    np.testing.assert_allclose(many.unknown.log_odds, [one.unknown.log_odds[0] for one in alone], rtol=1e-10)


def test_mistakes_are_said():
    for mass in (0.0, 1.0, float("nan")):
        with pytest.raises(InputError, match="novelty must lie between 0 and 1"):
            BayesianPolicyReuse(learnt(), novelty=mass)
    own = LikelihoodSignal(lambda policy, x: [0.0, -1.0, -2.0], 3)
    with pytest.raises(InputError, match="outcomes or categories"):
        BayesianPolicyReuse(learnt(signal=own), BeliefSampling(), novelty=0.05)
