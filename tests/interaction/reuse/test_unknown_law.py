import numpy as np
import pytest
from scipy.stats import norm, t

from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.reuse.unknown_law import UNIFORM, WEIGHTS, broad_counts, unknown_law
from lifelore.interaction.signals.category_signal import CategorySignal

MEAN, DEVIATION = np.array([[10.0, 3.0], [0.0, 3.0]]), np.array([[2.0, 1.0], [2.0, 1.0]])
PRIOR = np.array([0.5, 0.5])


def log_density(library, policy, signal, shown=None):
    """Of an outcome or a category of a task of the unknown type."""
    law = unknown_law(library)
    return law.log_likelihoods(policy, law.checked(signal), shown, 0).item()


@pytest.mark.parametrize("count", [None, 8.0])
def test_the_first_outcome_is_as_wide_as_types_and_noise(count):
    library = PolicyLibrary.from_means(MEAN, DEVIATION, count=count)
    # First policy: types at 10 and 0, so a spread of 25 beside a variance of 4. The types agree on the second
    # policy, which gets the mean spread of both policies, 12.5, beside a variance of 1.
    for policy, centre, variance in ((0, 5.0, 4 + 25), (1, 3.0, 1 + 12.5)):
        for value in (-20.0, 5.0, 9.0):
            # The variance is as well known as that of the types.
            law = norm(centre, variance**0.5) if count is None else t(count, centre, variance**0.5)
            assert log_density(library, policy, value) == pytest.approx(law.logpdf(value), abs=1e-12)


def test_categories_by_hand():
    # The types have nothing in common: the pooled probabilities (1/2, 1/2, 0) count as the least weight.
    probs = np.array([[[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]])
    counts = broad_counts(probs, PRIOR)[0, 0]
    pooled = (1 - UNIFORM) * np.array([0.5, 0.5, 0.0]) + UNIFORM / 3
    assert counts == pytest.approx(WEIGHTS[0] * pooled)
    library = PolicyLibrary.from_means([[1.0], [2.0]], 1.0, signal=CategorySignal(probs))
    assert np.exp(log_density(library, 0, 2)) == pytest.approx(UNIFORM / 3)
    shown = np.array([[[0.0, 0.0, 1.0]]])
    assert np.exp(log_density(library, 0, 2, shown)) == pytest.approx((0.5 * UNIFORM / 3 + 1) / 1.5)


def test_every_kind_of_outcome_has_an_unknown_law():
    random = np.random.default_rng(0)
    library = PolicyLibrary(HistogramOutcomes.from_samples(random.normal(0, 1, (2, 2, 80)), 10))
    cells = library.performance.cells  # pyright: ignore[reportAttributeAccessIssue]
    density = [np.exp(log_density(library, 1, value)) for value in cells.means]
    assert np.array(density) @ cells.sizes == pytest.approx(1)
    assert log_density(library, 1, 1e3) == -np.inf
    library = PolicyLibrary(CategoricalOutcomes([0.0, 1.0], [[[1.0, 0.0]], [[0.9, 0.1]]]))
    assert np.exp(log_density(library, 0, 1.0)) == pytest.approx((1 - UNIFORM) * 0.05 + UNIFORM / 2)
