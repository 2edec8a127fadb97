"""Measures of C4.15 on losses made by hand, and a tiny run."""

import numpy as np
import pytest

from lifelore.experiments.chapter4.ball_game.methods import METHODS, ORACLE, PRINTED_EXP3, STATIC, TUNED_EXP3
from lifelore.experiments.chapter4.c4_15_safety.measure import measure, rows, worst_ratio
from lifelore.experiments.chapter4.c4_15_safety.run import LAGGING, cells, run_cell
from lifelore.experiments.engine.registry import claim_of

CLAIM = claim_of("C4.15")


def made(n=30):
    """BEAT 10 % above the best in the first episode, at it later; the static speed 20 % above it, EXP-3 40 %."""
    generator = np.random.default_rng(0)
    best = 0.5 + generator.normal(0, 0.02, (6, n, 5))
    factor = {ORACLE: 1.0, STATIC: 1.2, PRINTED_EXP3: 1.4, TUNED_EXP3: 1.3}
    losses = {m: best * factor.get(m, 1.0) for m in (*METHODS, LAGGING)}
    losses["BEAT"] = best * np.array([1.1, 1, 1, 1, 1])
    losses["BEAT"][2, :, 1] *= 1.5
    return {
        "losses": {m: v.tolist() for m, v in losses.items()},
        "needed": [[10] * (n - 1) + [-1]] * 6,
        "right_speed": [[True] * n] * 6,
        "lengths": [[60] * n] * 6,
    }


def test_measures_by_hand():
    found = measure({}, [made()])
    assert found["to_static_first"].value == pytest.approx(1.1 / 1.2)
    assert found["to_static_last"].value == pytest.approx(1 / 1.2)
    assert found["to_exp3_last"].value == pytest.approx(1 / 1.4)
    assert found["worst_to_static"].value == pytest.approx(1.5 / 1.2)
    assert found["worst_to_static_last"].value == pytest.approx(1 / 1.2)
    # A tenth of 0.5 in one of five episodes, and a half of 0.5 in one of thirty.
    assert found["regret"].value == pytest.approx(0.5 * (0.1 / 5 + 0.5 / 30), abs=0.002)
    assert found["steps_needed_b20"].value == 10
    assert found["named_within_first_episode"].value == pytest.approx(29 / 30)
    assert found["right_speed_at_end"].value == 1
    assert found["to_static_with_lag"].value == pytest.approx(1 / 1.2)
    shown = rows({}, [made()])[-1]
    assert shown["named"][0][shown["steps"].index(8)] == 0
    assert shown["named"][0][shown["steps"].index(12)] == pytest.approx(0.967)


def test_the_worst_type_and_episode_are_found():
    theirs = np.ones((6, 10, 5))
    mine = theirs.copy()
    mine[4, :, 3] = 2.0
    ratio, where = worst_ratio(mine, theirs)
    assert (ratio.value, where) == (2.0, [4, 3])


def test_most_who_are_never_named_right_make_the_median_infinite():
    result = made()
    result["needed"] = [[-1] * 20 + [10] * 10] * 6
    found = measure({}, [result])
    assert found["steps_needed_b2"].value == np.inf
    assert found["steps_needed_b2"].ci95 is None


def test_a_tiny_run():
    settings = CLAIM.settings("quick", {"players": 3, "training": 6, "tuning": 2})
    result = run_cell(settings, cells(settings)[0], 0)
    assert np.shape(result["losses"]["BEAT"]) == (6, 3, 5)
    assert np.shape(result["needed"]) == np.shape(result["right_speed"]) == np.shape(result["lengths"]) == (6, 3)
