"""Trials: populations, players, means by size, and what each method knows."""

import numpy as np
import pytest

from reproduction.chapter4.ball_game.trials import (
    BEAT,
    BEAT_TOLD,
    BEATS,
    EXP3,
    HINDSIGHT,
    OPEN,
    ORACLE,
    POPULATIONS,
    STATIC,
    by_size,
    cells,
    confusion,
    readings_of,
    run_cell,
)
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C4.12")
SETTINGS = CLAIM.settings("quick", {"runs": 2, "games": ["s-maze 160"]})
RESULT = run_cell(SETTINGS, cells(SETTINGS)[0], 0)


def test_means_by_size_against_a_loop():
    lost = np.random.default_rng(0).random((63 * 4, 5))
    found = by_size(lost)
    for size in range(1, 7):
        for run in range(4):
            own = [lost[4 * i + run] for i, p in enumerate(POPULATIONS) if len(p) == size]
            assert found[size - 1, run] == pytest.approx(np.mean(own, axis=0))


def test_confusion_by_hand():
    counts = confusion(np.array([0, 0, 1, 2]), np.array([0, 1, 1, 0]))
    assert counts[:3, :3].tolist() == [[1, 1, 0], [0, 1, 0], [1, 0, 0]]
    assert counts.sum() == 4


def test_methods_are_given_what_they_are_said_to_be():
    losses = {method: np.array(lost) for method, lost in RESULT["losses"].items()}
    assert all(lost.shape == (6, 2, 5) for lost in losses.values())
    # In populations of one type the static speed is the best speed of that type, and so is that of a BEAT which
    # is told the population but for its exploration.
    np.testing.assert_array_equal(losses[STATIC][0], losses[ORACLE][0])
    assert losses[HINDSIGHT].mean() <= losses[STATIC].mean()
    np.testing.assert_allclose(losses[BEAT_TOLD][0, :, -1].mean(), losses[ORACLE][0, :, -1].mean(), rtol=0.2)
    assert set(RESULT["half"]) == set(BEATS)
    assert np.sum(RESULT["half"][BEAT]) == 126


def test_readings_are_games_and_single_choices():
    seen = []
    found = list(readings_of([RESULT, RESULT], lambda result, instead: seen.append(dict(instead)) or {}))
    assert len(found) == 2 + sum(map(len, OPEN.values())) == len(seen)
    assert seen[:2] == [{}, {}]
    assert {BEAT, EXP3, STATIC} == {method for instead in seen for method in instead}
    assert len({tuple(reading.items()) for reading, _ in found[1:]}) == len(found) - 1
