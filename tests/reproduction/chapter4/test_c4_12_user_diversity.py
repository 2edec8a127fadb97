"""Measures of C4.12 on losses made by hand, the crowd, and a tiny run."""

from math import comb

import numpy as np
import pytest

from reproduction.chapter4.ball_game.games import DEFAULT, Setting
from reproduction.chapter4.ball_game.methods import (
    HINDSIGHT,
    METHODS,
    ORACLE,
    PRINTED_EXP3,
    STATIC,
    TUNED_EXP3,
    crowd_of,
    known_of,
    run_methods,
)
from reproduction.chapter4.c4_12_user_diversity.measure import PRINTED, measure, rows
from reproduction.chapter4.c4_12_user_diversity.run import cells, run_cell
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C4.12")


def made(loss_of, runs=60):
    """Results of one game with these mean losses by method and diversity, and noise that pairs share."""
    generator = np.random.default_rng(0)
    found = []
    for x in range(1, 7):
        n = comb(6, x) * x * (runs // x)
        noise = generator.normal(0, 0.05, n)
        losses = {m: (loss_of(m, x) + noise + generator.normal(0, 0.005, n)).tolist() for m in METHODS}
        found.append(
            {
                "game": DEFAULT,
                "diversity": x,
                "populations": comb(6, x),
                "losses": losses,
                "gamma": 0.1,
                "best": [70] * 6,
            }
        )
    return found


def test_measures_by_hand():
    def loss_of(method, x):
        return {STATIC: 0.3 + 0.02 * x, PRINTED: 0.37, PRINTED_EXP3: 0.5, TUNED_EXP3: 0.4}.get(method, 0.33)

    settings = {"games": [DEFAULT]}
    results = made(loss_of)
    found = measure(settings, results)
    # Static: 0.32, 0.34, 0.36 below 0.37; 0.38, 0.40, 0.42 above it.
    assert found["printed_above_static_few"].value == 1
    assert found["printed_below_static_many"].value == 1
    assert found["printed_below_exp3"].value == 1
    assert found["largest_printed_to_exp3"].value == pytest.approx(0.74, abs=0.02)
    assert found["largest_printed_to_tuned_exp3"].value == pytest.approx(0.925, abs=0.01)
    assert found["beat_below_static_few"].value == pytest.approx(2 / 3)  # 0.33 against 0.32, 0.34, 0.36
    assert found["beat_to_oracle"].value == pytest.approx(1, abs=0.005)
    assert found["grid_below_exp3"].value == found["grid_sentence"].value == 1
    assert found["printed_to_exp3"].value == pytest.approx(0.74, abs=0.01)
    # 0.37 to the mean over 6, 15 and 20 populations of 0.32, 0.34 and 0.36.
    assert found["printed_to_static_few"].value == pytest.approx(0.37 / (14.22 / 41), abs=0.01)
    plain = {name: number.to_dict() for name, number in found.items()}
    assert CLAIM.predicate.verdict(plain) == "holds"
    row = rows(settings, results)[5]
    assert row["n"] == 60
    assert row["loss"][STATIC] == pytest.approx(0.42, abs=0.02)


def test_equal_losses_are_below_nothing():
    found = measure({"games": [DEFAULT]}, made(lambda method, x: 0.4))
    for name in ("printed_above_static_few", "printed_below_static_many", "printed_below_exp3"):
        assert found[name].value <= 0.5
    assert found["grid_sentence"].value == 0


def test_cells_give_every_diversity_enough_runs():
    settings = CLAIM.settings("full")
    first = cells(settings)[:6]
    assert [c["runs"] * comb(6, c["diversity"]) >= 600 for c in first] == [True] * 6
    assert min(c["runs"] for c in first) >= 100
    assert len(cells(settings)) == 6 * len(settings["games"])


def test_a_crowd_plays_every_type_of_every_population_as_often():
    crowd = crowd_of(2, 6, 7, np.random.default_rng(0))
    assert len(crowd.members) == 15
    for number, members in enumerate(crowd.members):
        kinds = crowd.players.kinds[crowd.population == number]
        assert np.bincount(kinds, minlength=6)[list(members)].tolist() == [4, 4]
        assert set(kinds.tolist()) == set(members)


def test_methods_are_given_what_they_are_said_to_be():
    known = known_of(Setting(*DEFAULT), 6, 2, 0)
    crowd = crowd_of(1, 6, 4, np.random.default_rng(1))
    found = run_methods(known, crowd, 0, "test")
    assert set(found) == set(METHODS)
    # In populations of one type, the static speed and the told BEAT are the best speed of that type.
    np.testing.assert_array_equal(found[STATIC], found[ORACLE])
    np.testing.assert_array_equal(found["BEAT, told the population"], found[ORACLE])
    means = [found[m].reshape(6, -1).mean(axis=1) for m in (HINDSIGHT, STATIC)]
    assert (means[0] <= means[1] + 1e-12).all()


def test_a_tiny_run():
    settings = CLAIM.settings("quick")
    result = run_cell(settings, {"game": DEFAULT, "diversity": 6, "runs": 6}, 0)
    assert {m: len(v) for m, v in result["losses"].items()} == dict.fromkeys(METHODS, 6)
    assert result["populations"] == 1
