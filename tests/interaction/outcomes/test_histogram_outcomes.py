"""Histograms with pseudo-counts, by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.cells import BinCells
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes


def by_hand():
    """Bins [0, 1), [1, 3]; three quarters and one quarter."""
    return HistogramOutcomes([0.0, 1.0, 3.0], [[[0.75, 0.25]]])


def test_numbers_by_hand():
    model = by_hand()
    assert model.mean[0, 0] == pytest.approx(0.75 * 0.5 + 0.25 * 2)
    # E[U²] = ¾ · 1/3 + ¼ · (27 - 1) / 6; minus the mean's square.
    assert model.deviation[0, 0] ** 2 == pytest.approx(0.25 + 26 / 24 - 0.875**2)
    assert model.density(np.array([0.0, 0.99, 1.0, 3.0, 3.01, -0.01]))[:, 0, 0].tolist() == [
        0.75, 0.75, 0.125, 0.125, 0.0, 0.0,
    ]  # fmt: skip
    # Above 0.5: half of the first bin, all of the second.
    assert model.exceedance(0.5)[0, 0] == pytest.approx(0.375 + 0.25)
    # ¾ · ∫ from 0.5 to 1 of (u - 0.5) + ¼ · (2 - 0.5)
    assert model.expected_excess(0.5)[0, 0] == pytest.approx(0.75 * 0.125 + 0.25 * 1.5)
    assert model.expected_excess(3.0)[0, 0] == 0
    assert model.bounds() == (0.0, 3.0)


def test_pseudo_counts_keep_what_was_never_seen_possible():
    data = [[[0.5, 0.5, 0.5]], [[2.5, 2.5, 2.5]]]
    with_them = HistogramOutcomes.from_samples(data, edges=[0.0, 1.0, 2.0, 3.0])
    np.testing.assert_allclose(with_them.probs[0, 0], [3.5 / 4.5, 0.5 / 4.5, 0.5 / 4.5])
    without = HistogramOutcomes.from_samples(data, edges=[0.0, 1.0, 2.0, 3.0], pseudo_count=0.0)
    assert without.log_density(0, 2.5).tolist() == [-np.inf, 0.0]
    assert np.isfinite(with_them.log_density(0, 2.5)).all()


@pytest.mark.parametrize(
    ("edges", "message"),
    [
        ([0.0, 1.0], r"counts must be \(n_types, n_policies, 1\), got \(1, 1, 2\)"),
        ([0.0], "edges must be finite numbers, one more than bins"),
        ([0.0, 2.0, 1.0], "edges must rise"),
        ([0.0, 1.0, 1.0], "edges must rise"),
        ([0.0, 1.0, np.inf], "edges must be finite numbers"),
    ],
)
def test_bad_edges_are_refused(edges, message):
    with pytest.raises(InputError, match=message):
        HistogramOutcomes(edges, [[[0.5, 0.5]]])


def test_other_bad_input_is_refused():
    with pytest.raises(InputError, match="outside the model's edges 0 to 2"):
        HistogramOutcomes.from_samples([[[5.0]]], edges=[0.0, 1.0, 2.0])
    with pytest.raises(InputError, match="pseudo_count must be"):
        HistogramOutcomes.from_samples([[[1.0]]], pseudo_count=-1.0)
    with pytest.raises(InputError, match="sum to 1"):
        HistogramOutcomes([0.0, 1.0, 2.0], [[[0.5, 0.6]]])
    with pytest.raises(InputError, match="at least 1 bin"):
        HistogramOutcomes.from_samples([[[1.0]]], edges=0)
    with pytest.raises(InputError, match="with a positive one"):
        HistogramOutcomes.of(BinCells([0.0, 1.0]), np.zeros((1, 1, 1)), 0.0)
    with pytest.raises(InputError, match="exact probabilities cannot learn"):
        by_hand().observe(0, 0, 0.5)
    learning = HistogramOutcomes([0.0, 1.0, 3.0], [[[0.75, 0.25]]], count=4)
    learning.observe(0, 0, 2.0)
    np.testing.assert_allclose(learning.probs, [[[0.6, 0.4]]])
    with pytest.raises(InputError, match="outside the model's edges"):
        learning.observe(0, 0, 3.5)
