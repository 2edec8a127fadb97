"""Measures of C4.12 on losses made by hand."""

import numpy as np
import pytest

from reproduction.chapter4.ball_game.trials import BEAT, BEAT_TOLD, EXP3, STATIC
from reproduction.chapter4.c4_12_user_diversity.run import numbers


def made():
    """BEAT loses 0.37, EXP-3 0.5 and the static speed 0.32 to 0.42 by size; runs share their noise."""
    generator = np.random.default_rng(0)
    noise = generator.normal(0, 0.05, (6, 60, 1)) + np.zeros(5)
    static = (0.3 + 0.02 * np.arange(1, 7))[:, None, None]
    losses = {BEAT: 0.37 + noise, BEAT_TOLD: 0.3 + noise, EXP3: 0.5 + noise, STATIC: static + noise}
    return {"losses": {method: lost.tolist() for method, lost in losses.items()}}


def test_measures_by_hand():
    found = numbers(made(), {})
    assert found["to_exp3"].value == pytest.approx(0.37 / 0.5, abs=0.01)
    # Every size of the population weighs as much: the static speed loses 0.34 and 0.40 on average.
    assert found["to_static_few"].value == pytest.approx(0.37 / 0.34, abs=0.01)
    assert found["to_static_many"].value == pytest.approx(0.37 / 0.40, abs=0.01)
    assert found["to_static_at_3"].value == pytest.approx(0.37 / 0.36, abs=0.01)
    assert found["to_static_few"].ci95[0] > 1 > found["to_static_many"].ci95[1]
    assert numbers(made(), {BEAT: BEAT_TOLD})["to_exp3"].value == pytest.approx(0.6, abs=0.01)
