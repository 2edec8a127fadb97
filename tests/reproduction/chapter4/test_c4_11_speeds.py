"""Measures of C4.11 on losses made by hand."""

import numpy as np
import pytest

from reproduction.chapter4.c4_11_speeds.run import losses, numbers, readings, rows
from reproduction.engine.registry import claim_of


def made(best, n=40, noise=0.01):
    """Losses with the least at `best` of each type: 0.1 for every 10 units away."""
    generator = np.random.default_rng(0)
    speeds = np.array([30, 40, 50, 60, 70])
    mean = np.abs(speeds - np.array(best)[:, None]) / 100
    return mean[:, :, None] + generator.normal(0, noise, (6, 5, n))


def test_a_transition_by_hand():
    found = numbers(made([70, 70, 60, 60, 50, 30]))
    # (0.4 + 0.3) / 2 - (0.1 + 0) / 2 = 0.3, and the same for the largest the other way round.
    assert found["small_gains_by_fast"].value == pytest.approx(0.3, abs=0.01)
    assert found["large_gains_by_slow"].value == pytest.approx(0.3, abs=0.01)
    assert found["best_speed_falls_by"].value == 40
    assert numbers(made([30, 30, 30, 30, 60, 70]))["best_speed_falls_by"].value == -40


def test_every_game_is_read_under_every_normalisation():
    loss = made([70, 60, 60, 60, 40, 30])
    # Without collisions the fixed scale of time, 400, gives the loss back.
    results = [
        {"game": game, "steps": (400 * loss).tolist(), "hits": (0 * loss).tolist()}
        for game in ("blobs", "s-maze 110")
    ]
    settings = {"normalisations": ["fixed", "maxima"]}
    found = list(readings(settings, results))
    assert [(cell["layout"], cell["normalisation"]) for cell, _ in found] == [
        ("blobs", "fixed"), ("blobs", "maxima"), ("s-maze 110", "fixed"), ("s-maze 110", "maxima"),
    ]  # fmt: skip
    assert found[0][1] == claim_of("C4.11").measured(settings, results)[0]
    assert losses(results[0], "maxima").max() == pytest.approx(1)
    assert rows(settings, results)[0]["loss"][0] == np.round(loss[0].mean(axis=1), 4).tolist()
