"""Golf by hand, by quadrature and by many shots."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import foldnorm, norm

from lifelore.core.errors import InputError
from lifelore.domains.golf.golf import EDGES, HOLES, Golf, category_of

GOLF = Golf()


def test_performance_is_that_of_a_folded_normal():
    for i, hole in enumerate(HOLES):
        for j in range(4):
            mean, deviation = GOLF.yards[j], GOLF.deviations[j]
            folded = foldnorm(abs(mean - hole) / deviation, scale=deviation)
            assert GOLF.mean[i, j] == pytest.approx(-folded.mean(), rel=1e-12)
            assert GOLF.deviation[i, j] == pytest.approx(folded.std(), rel=1e-9)


def test_the_six_iron_is_best_where_nothing_is_known():
    # The wood misses by 105, 65, 45 and 6.9 yards on average, the 6-iron by 40, 4.8, 20 and 70.
    assert GOLF.mean.mean(axis=0).argmax() == 2
    assert GOLF.mean.mean(axis=0) == pytest.approx([-55.65, -37.64, -33.70, -50.14], abs=0.005)


def test_categories_are_differences_of_normal_distributions():
    for i, hole in enumerate(HOLES):
        for j in range(4):
            below = norm.cdf(np.array(EDGES), GOLF.yards[j] - hole, GOLF.deviations[j])
            expected = np.diff([0.0, *below, 1.0])
            assert GOLF.category_probs[i, j] == pytest.approx(expected, abs=1e-13)
    assert GOLF.category_probs.sum(axis=-1) == pytest.approx(1, abs=1e-12)
    assert (GOLF.category_probs >= 0).all()


@pytest.mark.parametrize(
    ("error", "category"),
    [(-51, 0), (-50, 1), (-20, 2), (-5, 3), (0, 3), (5, 3), (5.1, 4), (20, 4), (35.4, 5), (50, 5), (50.1, 6)],
)
def test_category_of_an_error(error, category):
    assert category_of(error) == category


@given(st.floats(1, 400), st.sampled_from(range(4)))
@settings(deadline=None, max_examples=60)
def test_a_hole_at_any_distance(distance, club):
    probs = GOLF.category_probs_at(distance)
    assert (probs >= 0).all()
    assert probs.sum(axis=-1) == pytest.approx(1, abs=1e-12)
    # Never nearer on average than the bias or the spread alone would leave it.
    bias, deviation = abs(GOLF.yards[club] - distance), GOLF.deviations[club]
    assert -GOLF.mean_at(distance)[club] >= max(bias, deviation * (2 / np.pi) ** 0.5) - 1e-9


def test_drawn_holes_lie_where_the_thesis_draws_them():
    holes = GOLF.draw_holes(np.random.default_rng(0), 500)
    assert holes.shape == (500,)
    assert 120 <= holes.min() < 125
    assert 215 < holes.max() <= 220


@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"yards": ()}, "at least one club"),
        ({"holes": ()}, "at least one club and hole"),
        ({"deviations": (1.0,)}, "a deviation a club"),
        ({"deviations": (1.0, 1.0, 0.0, 1.0)}, "must be positive"),
    ],
)
def test_clubs_that_cannot_be(changes, rule):
    with pytest.raises(InputError, match=rule):
        Golf(**changes)
