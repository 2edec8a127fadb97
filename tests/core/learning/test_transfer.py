"""Transfer over a lifetime: by hand, by slow twins, and as L2Metrics has it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.learning.transfer import (
    average_performance,
    backward_transfer,
    forgetting,
    forward_transfer,
    lifetime_transfer,
    mean_pair_transfer,
    pair_transfer,
    performance_maintenance,
    relative_performance,
    sample_efficiency,
)
from lifelore.core.metrics import mean_estimate

LIFE = np.array([[1, 2, 4], [8, 4, 2], [6, 8, 4], [7, 4, 8]], float)
"""Before anything, then after tasks 0, 1 and 2; columns are the tasks."""
OWN = np.array([[1, 4, 4, 2], [2, 2, 6, 6], [0, 0, 3, 3]], float)
EXPERT = np.array([[1, 1, 2, 4, 4], [4, 4, 4, 4, 4], [1, 1, 1, 3, 3]], float)
lives = arrays(float, (5, 4), elements=st.integers(1, 40).map(float))


def test_differences_by_hand():
    assert average_performance(LIFE) == pytest.approx(19 / 3)
    assert forward_transfer(LIFE) == 1.0  # task 1: 4 - 2 before it is learnt; task 2: 4 - 4
    assert backward_transfer(LIFE) == -2.5  # 7 - 8 and 4 - 8
    assert forgetting(LIFE) == 2.5  # best after an earlier task: 8 of task 0, 8 of task 1
    assert performance_maintenance(LIFE) == -2.75  # task 0: mean of -2 and -1; task 1: -4; L2Metrics's too


def test_pairs_by_hand():
    nan = np.nan
    ratio = [[nan, 2, 0.5], [6 / 8, nan, 2], [7 / 6, 0.5, nan]]
    np.testing.assert_allclose(pair_transfer(LIFE), ratio)
    contrast = [[nan, 2 / 6, -2 / 6], [-2 / 14, nan, 2 / 6], [1 / 13, -4 / 12, nan]]
    np.testing.assert_allclose(pair_transfer(LIFE, "contrast"), contrast)


@pytest.mark.parametrize(
    ("form", "forward", "backward"), [("ratio", 1.5, 0.8055555556), ("contrast", 0.1111111111, -0.1330891331)]
)
def test_means_over_pairs_are_those_of_l2metrics(form, forward, backward):
    # What L2Metrics 3.1.0 says of this life, written by `agent.l2_log` and neither smoothed nor normalised.
    assert mean_pair_transfer(LIFE, form) == pytest.approx((forward, backward), abs=1e-9)


def test_beside_an_expert_by_hand():
    # Over four episodes each: 11 of 8, 16 of 16, 6 of 6; L2Metrics says their mean too, 1.125.
    np.testing.assert_allclose(relative_performance(OWN, EXPERT), [11 / 8, 1, 1])
    # Levels 4, 6, 3 after 2, 3, 3 episodes against 4, 4, 3 after 4, 1, 4.
    np.testing.assert_allclose(sample_efficiency(OWN, EXPERT), [2, 1.5 / 3, 4 / 3])
    # Means of two: 4, 6, 3 after 3, 4, 4 episodes against 4, 4, 3 after 5, 2, 5.
    np.testing.assert_allclose(sample_efficiency(OWN, EXPERT, window=2), [5 / 3, 1.5 / 2, 5 / 4])


def slow(life: np.ndarray) -> dict[str, float]:
    """The measures as they are written, task by task; R_{i, j} is `life[i]`, tasks from 1."""
    n = life.shape[1]
    r = {(i, j): life[i, j - 1] for i in range(n + 1) for j in range(1, n + 1)}
    kept = [[r[k, j] - r[j, j] for k in range(j + 1, n + 1)] for j in range(1, n)]
    return {
        "average_performance": sum(r[n, j] for j in range(1, n + 1)) / n,
        "forward_transfer": sum(r[j - 1, j] - r[0, j] for j in range(2, n + 1)) / (n - 1),
        "backward_transfer": sum(r[n, j] - r[j, j] for j in range(1, n)) / (n - 1),
        "forgetting": sum(max(r[k, j] for k in range(1, n)) - r[n, j] for j in range(1, n)) / (n - 1),
        "performance_maintenance": sum(sum(one) / len(one) for one in kept) / len(kept),
    }


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(lives, lives)
def test_lives_are_measured_one_by_one(one, other):
    found, twins = lifetime_transfer([one, other, one]), [slow(one), slow(other), slow(one)]
    for name in twins[0]:
        assert getattr(found, name).value == pytest.approx(np.mean([twin[name] for twin in twins]))
    paired = lifetime_transfer([one, other], [other, one])
    assert all(getattr(paired, name).value == pytest.approx(0) for name in twins[0])
    assert lifetime_transfer([one], [other]).forgetting.value == pytest.approx(
        twins[0]["forgetting"] - twins[1]["forgetting"]
    )


@settings(max_examples=20, deadline=None)
@given(lives)
def test_one_who_never_changes_transfers_nothing(life):
    still = np.repeat(life[:1], 5, axis=0)
    found = lifetime_transfer([still])
    assert [found.forward_transfer.value, found.backward_transfer.value, found.forgetting.value] == [0, 0, 0]
    assert mean_pair_transfer(still) == (1, 1)
    assert mean_pair_transfer(still, "contrast") == (0, 0)


def test_plain_data_has_an_interval_of_each_measure():
    lives = [LIFE, LIFE * 2, LIFE * 3]
    plain = lifetime_transfer(lives).to_dict()
    assert plain["forgetting"] == mean_estimate([2.5, 5.0, 7.5]).to_dict()
    assert plain["forgetting"]["ci95"] is not None


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: forward_transfer(np.zeros((3, 3))), r"\(..., n_tasks \+ 1, n_tasks\).*got \(3, 3\)"),
        (lambda: forward_transfer(np.zeros((2, 1))), "at least two tasks"),
        (lambda: forward_transfer(np.full((3, 2), np.nan)), "must be finite"),
        (lambda: lifetime_transfer(LIFE), r"must be \(n_lives, n_tasks \+ 1, n_tasks\), got \(4, 3\)"),
        (lambda: lifetime_transfer([LIFE], [LIFE, LIFE]), r"same lives, \(1, 4, 3\), got \(2, 4, 3\)"),
        (lambda: pair_transfer(LIFE - 3), "at least 0 for form 'ratio', got -2"),
        (lambda: mean_pair_transfer(LIFE * [0, 1, 1]), "got a 0; shift performance"),
        (lambda: relative_performance(OWN, EXPERT[:2]), "a curve for each of 3 tasks, got 2"),
        (lambda: relative_performance(OWN, EXPERT - 9), "positive total in every task, got -30"),
        (lambda: sample_efficiency(OWN, EXPERT - 9), "saturate above 0 in every task, got -6"),
        (lambda: sample_efficiency(OWN, EXPERT, window=5), r"window must lie in \[1, 4\], got 5"),
        (lambda: sample_efficiency(OWN[0], EXPERT), r"curves must be finite and \(n_tasks, n_episodes\)"),
    ],
)
def test_arguments_that_break_a_rule(call, words):
    with pytest.raises(InputError, match=words):
        call()


def test_forms_have_names():
    with pytest.raises(NotFoundError, match="form must be one of ratio, contrast, got 'log'"):
        pair_transfer(LIFE, "log")
