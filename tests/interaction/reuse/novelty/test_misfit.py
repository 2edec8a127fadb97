"""The statistic of an alarm: by hand, beside a naive twin, and for impossible signals."""

import numpy as np
import pytest
from scipy.stats import multinomial, norm

from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.novelty.misfit import Misfit, means_of_types, pairs_of
from lifelore.interaction.reuse.novelty.unknown_evidence import unknown_evidence
from lifelore.interaction.signals.category_signal import CategorySignal

EXACT = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 2.0)


def misfit_of(library: PolicyLibrary, n: int = 1) -> Misfit:
    return Misfit(unknown_evidence(library, n, dynamics=TypeDynamics.static()))


def test_outcomes_of_exact_types_are_a_likelihood_ratio():
    """Two outcomes of policy 0 and one of policy 1 have means of variances 2 and 4 on a known task."""
    misfit = misfit_of(EXACT)
    assert misfit.statistic(0) == 0
    for policy, outcome in ((0, 7.0), (0, 5.0), (1, 1.0)):
        misfit.observe(0, policy, outcome)
    known = [np.prod(norm.pdf([6, 1], mean, np.sqrt([2, 4]))) for mean in ([10, 0], [0, 10])]
    # The mean of the types is 5, so types like them pay 9.5 and 0.5; the broad type has 25 more variance.
    alike = [np.prod(norm.pdf([6, 1], mean, np.sqrt([2, 4]))) for mean in ([9.5, 0.5], [0.5, 9.5])]
    broad = np.prod(norm.pdf([6, 1], [5, 5], np.sqrt([27, 29])))
    expected = np.log((np.mean(alike) + broad) / 2) - np.log(np.mean(known))
    assert misfit.statistic(0) == pytest.approx(expected)
    assert (misfit.freedom[0], misfit.n_signals[0]) == (2, 3)


def test_a_new_type_beside_a_single_known_type_pays_less():
    """Two deviations less, or as broad as an outcome: a low outcome says more than a high one."""
    low, high = misfit_of(EXACT.take([0])), misfit_of(EXACT.take([0]))
    low.observe(0, 0, 7.0)
    high.observe(0, 0, 13.0)
    broad = norm.pdf(7, 10, 8**0.5)
    assert low.statistic(0) == pytest.approx(np.log((norm.pdf(7, 6, 2) + broad) / 2 / norm.pdf(7, 10, 2)))
    assert high.statistic(0) == pytest.approx(np.log((norm.pdf(13, 6, 2) + broad) / 2 / norm.pdf(13, 10, 2)))


def test_runs_leave_means_in_doubt():
    samples = np.random.default_rng(0).normal([[[4.0]], [[8.0]]], 1.0, (2, 1, 10))
    library = PolicyLibrary.from_samples(samples)
    model, misfit = library.performance, misfit_of(library)
    for outcome in (6.0, 7.0, 5.0):
        misfit.observe(0, 0, outcome)
    mean, doubt = means_of_types(model, library.prior)  # pyright: ignore[reportArgumentType]
    variance = model.moments.variance * (1 / 3 + doubt)  # pyright: ignore[reportAttributeAccessIssue]
    assert misfit.by_type[0, :2] == pytest.approx(((6 - mean) ** 2 / variance + np.log(variance))[:, 0])


def test_categories_of_exact_types_are_a_likelihood_ratio():
    probs = np.array([[[0.5, 0.3, 0.2]], [[0.1, 0.1, 0.8]]])
    library = PolicyLibrary.from_means([[1.0], [2.0]], 1.0, signal=CategorySignal(probs))
    misfit, counts = misfit_of(library), np.array([2, 1, 1])
    for category in (0, 2, 0, 1):
        misfit.observe(0, 0, category)
    best = multinomial.logpmf(counts, 4, counts / 4)
    assert misfit.by_type[0] == pytest.approx([2 * (best - multinomial.logpmf(counts, 4, p)) for p in probs[:, 0]])
    assert misfit.freedom[0] == 2
    assert misfit.statistic(0) == pytest.approx((misfit.by_type[0].min() - 2) / 4**0.5)


@pytest.mark.parametrize("kind", ["gaussian", "student-t", "histogram", "categorical"])
def test_rows_are_single_tasks_and_sums_are_those_of_all_pairs(kind):
    random = np.random.default_rng(0)
    library = PolicyLibrary.from_samples(np.round(random.normal(0, 2, (3, 4, 12))), model=kind)
    values = np.round(random.choice(library.performance.bounds()[1] * np.array([0.2, 0.5, 0.9]), (20, 9)))
    policies = random.integers(0, 4, (20, 9))
    many, alone = misfit_of(library, 20), [misfit_of(library) for _ in range(20)]
    for signal in range(9):
        many.observe(np.arange(20), policies[:, signal], values[:, signal])
        for row, one in enumerate(alone):
            one.observe(0, int(policies[row, signal]), float(values[row, signal]))
    singles = [one.statistic(0) for one in alone]
    np.testing.assert_allclose(many.statistic(np.arange(20)), singles, rtol=1e-9, atol=1e-9)
    # The naive sum over all pairs of what has been shown.
    pairs = pairs_of(library.signal, library.prior)
    shown = many.rows.unknown.shown
    whole = sum(pairs.misfit(shown[:, policy], np.full(20, policy)) for policy in range(4))
    np.testing.assert_allclose(many.by_type, whole, rtol=1e-9, atol=1e-9)
