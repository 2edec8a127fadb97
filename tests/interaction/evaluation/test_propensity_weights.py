"""Importance weights: quotients, products along users, and diagnostics; by hand and against plain loops."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.evaluation.propensity_weights import (
    decision_numbers,
    importance_weights,
    trajectory_weights,
    weight_summary,
)


@pytest.mark.parametrize(
    ("target", "logged", "words"),
    [
        ([0.5], [0.0], "logged must hold probabilities above 0 and at most 1, got 0 in row 0"),
        ([0.5, 0.5], [0.5, 1.5], "got 1.5 in row 1"),
        ([0.5], [np.nan], "got nan in row 0"),
        ([-0.1], [0.5], "target must hold probabilities in"),
        ([np.inf], [0.5], "target must hold"),
        ([0.5, 0.5], [0.5], "alike"),
        ([[0.5]], [[0.5]], "alike"),
    ],
)
def test_what_is_no_probability_is_refused(target, logged, words):
    with pytest.raises(InputError, match=words):
        importance_weights(target, logged)


def test_a_sum_of_rounded_probabilities_may_exceed_1():
    assert importance_weights([1 + 1e-16, 1 + 1e-12], [1 + 1e-12, 0.5]).tolist() == pytest.approx([1, 2])


def test_products_are_those_of_a_loop():
    generator = np.random.default_rng(0)
    users, weights = generator.integers(0, 9, 200), generator.random(200) * (generator.random(200) < 0.9)
    before, through = trajectory_weights(weights, users)
    numbers = decision_numbers(users)
    product, count = dict.fromkeys(users.tolist(), 1.0), dict.fromkeys(users.tolist(), 0)
    for row, user in enumerate(users.tolist()):
        assert before[row] == product[user]
        assert numbers[row] == count[user]
        product[user] *= weights[row]
        count[user] += 1
        assert through[row] == product[user]


def test_summary_by_hand():
    found = weight_summary(np.array([4.0, 0.0, 0.0, 2.0, 2.0]), ["a", "a", "b", "c", "c"])
    assert found.mean == 1.6
    assert found.largest == 4
    assert found.effective_decisions == pytest.approx(64 / 24)
    assert found.effective_users == pytest.approx(64 / 32)
    assert found.largest_share == 0.5
    # Sums of w − 1.6 over 5: a 0.16, b −0.32, c 0.16; 3 / 2 of the sum of squares.
    assert found.standard_error == pytest.approx(np.sqrt(1.5 * (0.16**2 * 2 + 0.32**2)))
    assert set(found.to_dict()) == set(found.__dataclass_fields__)


def test_equal_weights_are_as_many_as_there_are():
    found = weight_summary(np.full(12, 1e-200), np.arange(12) // 3)
    assert found.effective_decisions == pytest.approx(12)
    assert found.effective_users == pytest.approx(4)


def test_without_weight_there_is_no_evidence():
    found = weight_summary(np.zeros(4), [0, 0, 1, 2])
    assert (found.effective_users, found.largest_share, found.mean) == (0, 0, 0)
