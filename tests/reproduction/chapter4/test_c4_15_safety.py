"""Measures of C4.15 on losses made by hand."""

import numpy as np
import pytest

from reproduction.chapter4.ball_game.trials import BEAT, BEAT_OURS, EXP3, ORACLE, STATIC
from reproduction.chapter4.c4_15_safety.run import numbers


def made():
    """BEAT loses 10 % more than the best in the first episode, as much later; static 20 % and EXP-3 40 % more."""
    best = 0.5 + np.random.default_rng(0).normal(0, 0.02, (6, 30, 5))
    losses = {ORACLE: best, STATIC: 1.2 * best, EXP3: 1.4 * best, BEAT: best * [1.1, 1, 1, 1, 1], BEAT_OURS: best}
    return {
        "losses": {method: lost.tolist() for method, lost in losses.items()},
        "half": {BEAT: (10 * np.eye(6, dtype=int)).tolist()},
    }


def test_measures_by_hand():
    found = numbers(made(), {})
    assert found["last_to_static"].value == pytest.approx(1 / 1.2)
    assert found["last_to_exp3"].value == pytest.approx(1 / 1.4)
    # A tenth of the loss in one of five episodes, to four tenths in each.
    assert found["regret_to_exp3"].value == pytest.approx(0.1 / 2.0, rel=0.02)
    assert found["regret_to_exp3_without_exploration"].value == 0
    assert found["worst_ratio_10_to_60"].value == 1
