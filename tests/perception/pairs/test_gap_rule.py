"""The limit of *adjacent*, worked by hand; directed classes and their mirror images."""

import numpy as np
import pytest

from lifelore.core.relations import ADJACENT, BOTH, NONE, ON, SYMMETRIC, PairLabel
from lifelore.perception.pairs.directed_label import as_directed, directed_classes, mirror_order, mirrored
from lifelore.perception.pairs.gap_rule import BESIDE, HIDDEN_EDGE, applies, inner_label, resolve_beside
from lifelore.perception.trees.tree_relations import apply_temperature
from lifelore.perception.trees.tree_training import best_temperature


@pytest.mark.parametrize(
    ("label", "gap", "inner"),
    [
        (ADJACENT, 0.010, BESIDE),
        (ADJACENT, 0.026, BESIDE),
        (ADJACENT, 0.040, ADJACENT),
        (NONE, 0.050, BESIDE),
        (NONE, 0.018, BESIDE),
        (NONE, 0.005, NONE),
        (ON, 0.001, ON),
        (BOTH, 0.050, BOTH),
    ],
)
def test_a_label_that_the_gap_explains_is_beside(label, gap, inner):
    assert inner_label(label, gap, 0.0225) == inner


def test_beside_is_shared_out_by_the_gap_and_nothing_is_lost():
    gaps = np.array([0.001, 0.0225 + HIDDEN_EDGE, 0.1])
    shares = {BESIDE: np.full(3, 0.6), ON: np.full(3, 0.3), ADJACENT: np.full(3, 0.1)}
    found = resolve_beside(shares, gaps, 0.0225)
    np.testing.assert_allclose(found[ADJACENT], [0.7, 0.4, 0.1], atol=1e-4)
    np.testing.assert_allclose(found[NONE], [0.0, 0.3, 0.6], atol=1e-4)
    np.testing.assert_allclose(sum(found.values()), 1.0)
    assert BESIDE not in found


def test_a_gap_beyond_the_limit_may_hide_a_contact_and_a_gap_below_it_hides_none():
    gaps = 0.0225 + HIDDEN_EDGE + np.array([-0.006, 0.006])
    below, above = resolve_beside({BESIDE: np.ones(2)}, gaps, 0.0225)[ADJACENT]
    # Logistic functions of 6 mm over 1.5 mm and over 4 mm.
    assert below == pytest.approx(1 / (1 + np.exp(-4)))
    assert above == pytest.approx(1 / (1 + np.exp(1.5)))


def test_the_rule_needs_both_words_and_a_limit():
    assert applies((ADJACENT, NONE, ON), 0.02)
    assert not applies((ADJACENT, ON), 0.02)
    assert not applies((ADJACENT, NONE), None)


def test_directed_classes_have_their_mirror_images():
    classes = directed_classes((ON, ADJACENT), SYMMETRIC)
    assert classes == ("adjacent", "on", "~on")
    assert mirror_order(classes, SYMMETRIC) == [0, 2, 1]
    assert mirrored(mirrored("~on", SYMMETRIC), SYMMETRIC) == "~on"
    assert as_directed(PairLabel(3, 2, ON), 2, SYMMETRIC) == "~on"
    assert as_directed(PairLabel(3, 2, ADJACENT), 2, SYMMETRIC) == "adjacent"


def test_temperature_undoes_the_sureness_it_finds():
    rng = np.random.default_rng(0)
    true = rng.dirichlet([1, 1, 1], 4000)
    happened = (rng.random(4000)[:, None] < np.cumsum(true, axis=1)).argmax(axis=1)
    for wrong in (0.5, 1.0, 1.6):
        shown = apply_temperature(true, 1 / wrong)
        found = best_temperature(list(zip(shown, happened.tolist(), strict=True)))
        assert abs(found - wrong) < 0.15
    np.testing.assert_allclose(apply_temperature(true, 0.5).sum(axis=1), 1.0)
    assert best_temperature([]) == 1.0
