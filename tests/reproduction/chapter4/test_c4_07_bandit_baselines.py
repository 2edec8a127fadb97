"""Comparisons from made-up sums by hand."""

import pytest

from reproduction.chapter4.c4_07_bandit_baselines.run import more_regret
from reproduction.chapter4.surveillance.peers import PEERS


def test_comparisons_by_hand():
    base = dict.fromkeys(PEERS, 400.0) | {"EI": 100.0, "UCB1": 500.0, "UCB1, tuned": 300.0}
    found = {name: {"groups": 3, "sums": [sum_ + task for task in range(6)]} for name, sum_ in base.items()}
    values = {name: one.value for name, one in more_regret(found).items()}
    assert values == pytest.approx(
        {
            "UCB1_minus_EI": 400,
            "GP_UCB_minus_EI": 300,
            "interval_estimation_minus_EI": 300,
            "UCB1_minus_GP_UCB": 100,
        }
    )
    tuned = more_regret(found, "UCB1, tuned", "GP-UCB, tuned")
    assert tuned["UCB1_minus_GP_UCB"].value == pytest.approx(-100)
