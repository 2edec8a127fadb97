"""Measures of C4.11 on losses made by hand, and a tiny run."""

import numpy as np
import pytest

from reproduction.chapter4.c4_11_speeds.measure import (
    best_speeds,
    gains,
    has_transition,
    losses,
    measure,
    rows,
)
from reproduction.chapter4.c4_11_speeds.run import cells, run_cell
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C4.11")


def made(best, n=40, noise=0.01):
    """Losses with the least at `best` of each type: 0.1 for every 10 units away."""
    generator = np.random.default_rng(0)
    speeds = np.array([30, 40, 50, 60, 70])
    mean = np.abs(speeds - np.array(best)[:, None]) / 100
    return mean[:, :, None] + generator.normal(0, noise, (6, 5, n))


def test_a_transition_by_hand():
    loss = made([70, 70, 60, 60, 50, 30])
    assert best_speeds(loss).tolist() == [70, 70, 60, 60, 50, 30]
    small, large = gains(loss)
    # (0.4 + 0.3) / 2 - (0.1 + 0) / 2 = 0.3, and the same for the largest the other way round.
    assert (small.value, large.value) == (pytest.approx(0.3, abs=0.01), pytest.approx(0.3, abs=0.01))
    assert has_transition(loss)
    assert not has_transition(made([70] * 6))
    assert not has_transition(made([30] * 6))
    assert not has_transition(made([70, 70, 60, 60, 50, 50]))  # 50 is neither slow nor fast: no gain


def result_of(loss):
    """Steps that give these losses, no collisions."""
    return {
        "game": ["s-maze 160", 0.5, 3.0, "fixed", "slides"],
        "steps": (400 * loss).tolist(),
        "hits": (0 * loss).tolist(),
    }


def test_measures_by_hand():
    falling, rising = result_of(made([70, 60, 60, 60, 40, 30])), result_of(made([30, 30, 30, 30, 60, 70]))
    found = measure({}, [falling, rising])
    assert found["best_speed_falls_by"].value == 40
    assert found["best_speed_rises_by"].value == 0
    assert found["grid_with_transition"].value == 0.5
    assert measure({}, [rising])["best_speed_rises_by"].value == 30
    row = rows({}, [falling])[0]
    assert row["transition"]
    assert (row["game"], row["blocked"]) == (["s-maze 160", 0.5, 3.0], "slides")
    assert row["best"] == [70, 60, 60, 60, 40, 30]


def test_a_tiny_run_pairs_the_noise_of_all_speeds():
    settings = CLAIM.settings("quick", {"episodes": 4})
    result = run_cell(settings, cells(settings)[0], 0)
    assert np.shape(result["steps"]) == np.shape(result["hits"]) == (6, 5, 4)
    assert losses(result, "maxima").max() <= 2
