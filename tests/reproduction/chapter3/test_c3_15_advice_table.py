"""Claim C3.15: measures and rows from made-up mazes by hand; goals kept apart; printed intervals."""

import pytest
from scipy.stats import beta

from reproduction.chapter3.c3_15_advice_table.run import TABLE, readings, rows
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.15")
SETTINGS = {**CLAIM.sizes["quick"], "loops": [0.1, 0.4], "experts": ["walks"], "alpha0": [0.1]}
ALONE = {"random": 50.0, "avoid": 50.0, "left": 150.0, "bug": 100.0, "optimal": 1000.0, "q_learning": 150.0}


def maze(loops, gain, learns=True):
    alone = {agent: reward for agent, reward in ALONE.items() if learns or agent != "q_learning"}
    advised = {agent: reward + gain * (agent != "optimal") for agent, reward in alone.items()}
    apart = {agent: 900.0 for agent in alone if agent != "q_learning"}
    return {"loops": loops, "alone": alone, "advised": [advised], "apart": apart}


def test_numbers_by_hand():
    results = [maze(0.1, 100.0), maze(0.1, 300.0), maze(0.4, -20.0), maze(0.4, -40.0, learns=False)]
    found, _ = CLAIM.measured(SETTINGS, results)
    assert found["gain_random"].value == found["gain_q_learning"].value == 200.0
    assert found["explorers_alone"].value == 87.5
    assert found["explorers_advised"].value == 287.5
    assert found["explorers_apart"].value == 900.0
    assert found["q_learning_advised"].value == 350.0
    (default, same), (reading, other) = readings(SETTINGS, results)
    assert (default, reading["loops"]) == ({"loops": 0.1, "experts": "walks", "alpha0": 0.1}, 0.4)
    assert same["gain_bug"] == found["gain_bug"]
    assert (other["gain_bug"].value, other["gain_q_learning"].value, other["gain_q_learning"].n) == (-30, -20, 1)
    drawn = rows(SETTINGS, results)
    assert [row["agent"] for row in drawn] == ["random", "avoid", "left", "bug", "q_learning", "optimal"]
    assert (drawn[0]["advised"]["value"], "apart" in drawn[4]) == (250.0, False)


def test_intervals_of_the_printed_rewards():
    bounds = {one.measure: one.bound for one in CLAIM.statements}
    explorers = [TABLE[agent] for agent in ("random", "avoid", "left", "bug")]
    for way, measure_name in enumerate(("explorers_alone", "explorers_advised")):
        right = sum(printed[way] for printed in explorers) * 20 / 1000
        ends = 1000 * beta.ppf(0.025, right, 81 - right), 1000 * beta.ppf(0.975, right + 1, 80 - right)
        assert bounds[measure_name] == pytest.approx(ends, abs=0.5)
    assert bounds["q_learning_advised"] == pytest.approx((1000 * beta.ppf(0.025, 20, 1), 1000), abs=0.5)
