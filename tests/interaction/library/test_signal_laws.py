import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.library.signal_laws import signal_laws
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.outcomes.student_t_outcomes import StudentTOutcomes
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal


def test_the_surprise_of_a_single_normal_is_its_entropy():
    laws = signal_laws(PolicyLibrary.from_means([[3.0]], 2.0))
    expected, variance = laws.cells(0).expected_surprise(np.ones((1, 1)))
    assert expected[0] == pytest.approx(0.5 * np.log(2 * np.pi * np.e * 4), abs=0.01)
    assert variance[0] == pytest.approx(0.5, abs=0.02)  # half the variance of a squared standard normal's half


@pytest.mark.parametrize("model", ["gaussian", "student-t"])
def test_moments_of_the_surprise_agree_with_samples_of_the_mixture(model):
    random = np.random.default_rng(0)
    mean, deviation = random.normal(0, 30, (5, 3)), random.uniform(1, 20, (5, 3))
    count = np.full((5, 3), 8.0)
    library = PolicyLibrary.from_means(mean, deviation)
    if model == "student-t":
        library = PolicyLibrary(StudentTOutcomes(mean, deviation, count))
    laws, belief = signal_laws(library), random.dirichlet(np.ones(5), 4)
    n = 40_000
    for policy in range(3):
        expected, variance = laws.cells(policy).expected_surprise(belief)
        for row in range(4):
            types = random.choice(5, n, p=belief[row])
            values = np.array([library.performance.sample(random, t, policy) for t in types])
            density = np.exp(laws.log_likelihoods(np.full(n, policy), values)) @ belief[row]
            surprise = -np.log(density)
            # Five standard errors of the mean; the cells themselves may be off by 0.01 nats.
            assert expected[row] == pytest.approx(surprise.mean(), abs=5 * surprise.std() / n**0.5 + 0.01)
            assert variance[row] == pytest.approx(surprise.var(), rel=0.15)


def test_categories_give_the_exact_entropy_by_hand():
    library = PolicyLibrary.from_means([[1.0], [2.0]], 1.0, signal=CategorySignal([[[0.5, 0.5]], [[1.0, 0.0]]]))
    expected, variance = signal_laws(library).cells(0).expected_surprise(np.array([[0.5, 0.5], [0.0, 1.0]]))
    logs = -np.log([0.75, 0.25])
    by_hand = 0.75 * logs[0] + 0.25 * logs[1]
    assert expected == pytest.approx([by_hand, 0.0])
    assert variance == pytest.approx([0.75 * logs[0] ** 2 + 0.25 * logs[1] ** 2 - by_hand**2, 0.0])


def test_outcomes_of_a_few_values_are_categories():
    laws = signal_laws(PolicyLibrary(CategoricalOutcomes([10, 3], [[[1.0, 0.0]], [[0.25, 0.75]]])))
    assert (laws.n_categories, laws.pays) == (2, True)
    assert laws.numbers([10.0, 3.0]).tolist() == [1.0, 0.0]
    assert laws.outcomes(np.array([1.0, 0.0])).tolist() == [10.0, 3.0]
    likelihood = laws.log_likelihoods(np.zeros(2, np.int64), np.array([1.0, 0.0]))
    assert np.exp(likelihood).tolist() == [[1.0, 0.25], [0.0, 0.75]]


def test_names_of_categories_become_numbers():
    signal = CategorySignal([[[0.9, 0.1]], [[0.2, 0.8]]], categories=["near", "far"])
    laws = signal_laws(PolicyLibrary.from_means([[1.0], [2.0]], 1.0, signal=signal))
    assert laws.numbers(["far", "near"]).tolist() == [1.0, 0.0]


def test_the_cells_of_a_histogram_are_its_bins():
    model = HistogramOutcomes.from_samples(np.random.default_rng(0).normal(0, 1, (2, 3, 50)), 12)
    cells = signal_laws(PolicyLibrary(model)).cells(1)
    np.testing.assert_allclose(cells.probs, model.probs[:, 1], atol=1e-12)
    np.testing.assert_allclose(np.exp(cells.log_sizes), np.diff(model.edges))


def test_other_signals_are_refused():
    signal = LikelihoodSignal(lambda policy, seen: np.zeros(2), n_types=2)
    with pytest.raises(InputError, match="outcomes or categories, got LikelihoodSignal"):
        signal_laws(PolicyLibrary.from_means([[1.0], [2.0]], 1.0, signal=signal))
