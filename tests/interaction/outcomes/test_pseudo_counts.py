"""Pseudo-counts by held-out likelihood: against sample by sample, few samples, and the models that take them."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction import CategorySignal, PolicyLibrary, StepRewardSignal, TransitionSignal
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.outcomes.pseudo_counts import (
    CANDIDATES,
    SPREAD,
    USUAL,
    checked_pseudo_count,
    held_out_pseudo_count,
)


def naive(counts: np.ndarray, possible: np.ndarray | None = None) -> float:
    """Each sample held out in turn, and predicted from the rest of its row."""
    possible = np.ones(counts.shape, bool) if possible is None else possible
    best, chosen = -np.inf, 0.0
    for alpha in CANDIDATES.tolist():
        score = -0.5 * (np.log(alpha / USUAL) / SPREAD) ** 2
        for row, allowed in zip(counts, possible, strict=True):
            for cell in np.repeat(np.arange(row.size), row.astype(int)):
                rest = row.astype(float)
                rest[cell] -= 1
                if rest.sum():
                    score += np.log((rest[cell] + alpha) / (rest.sum() + alpha * allowed.sum()))
        if score > best:
            best, chosen = score, alpha
    return chosen


@pytest.mark.parametrize("concentration", [0.02, 0.3, 5.0])
def test_the_closed_form_is_that_of_each_sample_held_out(concentration):
    random = np.random.default_rng(0)
    probs = random.dirichlet(np.full(4, concentration), 9)
    counts = np.stack(
        [random.multinomial(n, row) for n, row in zip([0, 1, 1, 2, 3, 5, 8, 8, 20], probs, strict=True)]
    )
    assert held_out_pseudo_count(counts) == naive(counts)
    possible = (counts > 0) | (random.random(counts.shape) < 0.5)
    assert held_out_pseudo_count(counts, possible) == naive(counts, possible)
    assert held_out_pseudo_count(counts.reshape(3, 3, 4)) == held_out_pseudo_count(counts)


def test_every_model_of_counts_takes_it():
    random = np.random.default_rng(3)
    samples = random.integers(0, 3, (2, 4, 10)).astype(float)
    counts = np.stack([(samples == cell).sum(axis=2) for cell in range(3)], axis=2)
    alpha = held_out_pseudo_count(counts)
    expected = (counts + alpha) / (counts + alpha).sum(axis=2, keepdims=True)
    assert CategorySignal.from_samples(samples, pseudo_count="held-out").probs == pytest.approx(expected)
    outcomes = CategoricalOutcomes.from_samples(samples, pseudo_count="held-out")
    assert outcomes.probs == pytest.approx(expected)
    assert outcomes.pseudo_count == alpha
    histogram = HistogramOutcomes.from_samples(samples, [-0.5, 0.5, 1.5, 2.5], "held-out")
    assert histogram.probs == pytest.approx(expected)
    library = PolicyLibrary.from_samples(samples, model="categorical", pseudo_count="held-out")
    assert library.performance.mean == pytest.approx(expected @ np.arange(3.0))
    steps = random.integers(0, 5, (2, 3, 1, 3))
    by_number = TransitionSignal.from_counts(steps, held_out_pseudo_count(steps))
    assert np.array_equal(TransitionSignal.from_counts(steps, "held-out").probs, by_number.probs)
    possible = np.triu(np.ones((3, 3), bool))[:, None]
    steps = steps * possible
    by_number = TransitionSignal.from_counts(steps, held_out_pseudo_count(steps, possible), possible)
    found = TransitionSignal.from_counts(steps, "held-out", possible)
    assert np.array_equal(found.probs, by_number.probs)
    assert (found.probs[:, 2, 0, :2] == 0).all()
    episodes = [(0, 0, [(0, 0, 1.0)] * 4), (1, 0, [(0, 0, 0.0)] * 4)]
    chosen = StepRewardSignal.from_sequences(episodes, [0.0, 1.0], 2, 1, pseudo_count="held-out")
    assert chosen.probs[0, 0, 0, 1] > StepRewardSignal.from_sequences(episodes, [0.0, 1.0], 2, 1).probs[0, 0, 0, 1]


@pytest.mark.parametrize("bad", [-1.0, np.inf, np.nan, "best"])
def test_a_pseudo_count_is_a_number_or_the_word(bad):
    with pytest.raises(InputError, match="pseudo_count must be"):
        checked_pseudo_count(bad, np.ones((2, 3)))
    with pytest.raises(InputError, match="pseudo_count must be"):
        CategorySignal.from_samples([[[0, 1]]], pseudo_count=bad)
