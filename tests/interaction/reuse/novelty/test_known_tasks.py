import numpy as np
import pytest

from lifelore.interaction import CategorySignal, PolicyLibrary
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.reuse.novelty.known_tasks import drawn_moments, drawn_probs, known_tasks
from lifelore.interaction.reuse.novelty.misfit import means_of_types

N = 20_000


def test_exact_models_give_their_own_means_and_deviations():
    library = PolicyLibrary.from_means([[1.0, 5.0], [3.0, 9.0]], [[1.0, 2.0], [1.0, 2.0]], prior=[0.0, 1.0])
    signals = known_tasks(library, N, np.random.default_rng(0))(np.full(N, 1))
    assert signals.mean() == pytest.approx(9, abs=5 * 2 / N**0.5)
    assert signals.std() == pytest.approx(2, rel=0.03)


def test_means_of_learnt_models_differ_by_their_standard_error():
    random = np.random.default_rng(0)
    library = PolicyLibrary.from_samples(
        random.normal(0, 300.0, (30, 20, 1)) + random.normal(0, 3.0, (30, 20, 10))
    )
    model, prior = library.performance, library.prior
    mean, deviation = drawn_moments(model, np.zeros(N, np.int64), prior, np.random.default_rng(1))
    assert (mean - model.mean[0]).std() == pytest.approx(3 / 10**0.5, rel=0.05)
    assert deviation.mean() == pytest.approx(3, rel=0.05)
    # The least spread of the tasks of a type is an outcome's variance more.
    model.spread = Spread.known(1.0)
    mean, _ = drawn_moments(model, np.zeros(N, np.int64), prior, np.random.default_rng(1))
    assert (mean - model.mean[0]).std() == pytest.approx(3 * (1 / 10 + 1) ** 0.5, rel=0.05)


def test_means_of_few_runs_are_drawn_towards_the_mean_of_all_types():
    """True means have the variance 1 and sample means an error of 1/4: the posterior has 4/5 of both."""
    random = np.random.default_rng(0)
    true = random.standard_normal((400, 5))
    library = PolicyLibrary.from_samples(true[..., None] + random.standard_normal((400, 5, 4)), shrinkage=1e6)
    mean, doubt = means_of_types(library.performance, library.prior)
    np.testing.assert_allclose(doubt, 0.2, rtol=0.05)
    # 2000 squares: three standard errors.
    assert ((mean - true) ** 2).mean() == pytest.approx(0.2, rel=3 * (2 / 2000) ** 0.5)
    alone = PolicyLibrary.from_samples(np.arange(4.0)[None, None])
    mean, doubt = means_of_types(alone.performance, alone.prior)
    assert (mean[0, 0], doubt[0, 0]) == (1.5, 0.25)


def test_learnt_categories_vary_with_their_count_and_exact_ones_do_not():
    probs = [[[0.5, 0.5, 0.0]]]
    exact = PolicyLibrary.from_means([[1.0]], 1.0, signal=CategorySignal(probs))
    types = np.zeros(5000, np.int64)
    assert np.unique(drawn_probs(exact.signal, types, np.random.default_rng(0))[:, 0, 0]).tolist() == [0.5]
    learnt = PolicyLibrary.from_means([[1.0]], 1.0, signal=CategorySignal(probs, count=9))
    share = drawn_probs(learnt.signal, types, np.random.default_rng(0))[:, 0, 0]
    assert share.var() == pytest.approx(0.25 / 10, rel=0.1)  # Dirichlet: p (1 - p) / (count + 1)
    assert (known_tasks(learnt, 5000, np.random.default_rng(0))(types) < 2).all()


def test_outcomes_of_a_few_values_and_of_bins():
    random = np.random.default_rng(0)
    library = PolicyLibrary.from_samples(random.choice([0.0, 1.0], (2, 2, 20)), model="categorical")
    signals = known_tasks(library, 200, random)(np.zeros(200, np.int64))
    assert set(signals.tolist()) == {0.0, 1.0}
    library = PolicyLibrary(HistogramOutcomes.from_samples(random.normal(0, 1, (2, 2, 80)), 10))
    signals = known_tasks(library, 200, random)(np.zeros(200, np.int64))
    low, high = library.performance.bounds()
    assert (signals >= low).all()
    assert (signals <= high).all()
    assert len(np.unique(signals)) == 200
