"""Measures of C3.17 from made-up cells, by hand."""

import pytest

from lifelore.core.errors import InputError
from reproduction.chapter3.c3_17_advice_cost.measure import agents_of, measure, rows
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.17")
FULL = dict(claim_of("C3.17").sizes["full"])
QUICK = dict(claim_of("C3.17").sizes["quick"])

SETTINGS = {**QUICK, "kappas": [0.0, 0.5, 1.4]}
FALLING = {
    "random": [80, 40, 0],
    "avoid": [60, 20, 0],
    "left": [60, 10, 0],
    "bug": [60, 30, 0],
    "optimal": [50, 2, 0],
    "q 1": [80, 40, 0],
    "q 50": [50, 5, 0],
}


def made_up(changed=None):
    """Three mazes of 100 steps, 80 of them where experts passed; one step more advised in each maze at κ = 0.5."""
    cells = []
    for maze in range(3):
        amounts = []
        for experts in SETTINGS["experts"]:
            for agent, advised in {**FALLING, **(changed or {})}.items():
                for heeds in (True, False):
                    counts = [80, advised[1] + maze, advised[2]] if agent in ("random", "q 1") else list(advised)
                    known = [advised[0], 80, 80]
                    how = {"experts": experts, "agent": agent, "heeds": heeds}
                    amounts.append({**how, "steps": [100] * 3, "known": known, "advised": counts})
        ceilings = [
            {"experts": e, "states": [1.0, 0.5 + 0.1 * maze, 0.0], "above": 0} for e in SETTINGS["experts"]
        ]
        cells.append({"loops": 0.1, "maze": maze, "amounts": amounts, "ceilings": ceilings})
    return cells


def test_headline_by_hand():
    found = measure(SETTINGS, made_up())
    assert found["advice_at_zero"].value == 100.0
    assert found["agents_falling"].value == 1.0
    assert found["largest_rise"].value == 0.0
    assert found["largest_rise_over_mazes"].ci95 == (0.0, 0.0)
    assert (found["early_minus_random"].value, found["early_minus_random"].ci95) == (0.0, (0.0, 0.0))
    assert found["late_minus_optimal"].value == 3.0
    assert (found["grid_falling"].value, found["grid_falling"].n) == (1.0, 4)


def test_advice_that_rises_between_any_two_kappas_counts():
    found = measure(SETTINGS, made_up({"bug": [60, 20, 33]}))
    assert found["largest_rise"].value == 13.0
    assert found["largest_rise_over_mazes"].ci95 == (13.0, 13.0)
    assert found["agents_falling"].value == 1.0
    assert found["grid_falling"].value == 0.0


def test_the_largest_rise_has_an_interval_over_mazes():
    # Advice to the bug rises by 5, to random motion by 10, 9 and 8 in the three mazes.
    rise = measure(SETTINGS, made_up({"bug": [60, 20, 25], "random": [80, 40, 50]}))["largest_rise_over_mazes"]
    assert rise.value == 9.0
    assert 8.0 <= rise.ci95[0] < rise.ci95[1] <= 10.0
    # The rise is counted from the lowest mean before it, wherever that is.
    assert measure(SETTINGS, made_up({"bug": [20, 60, 0]}))["largest_rise_over_mazes"].value == 40.0


def test_an_agent_that_is_told_as_often_at_the_end_does_not_fall():
    assert measure(SETTINGS, made_up({"left": [60, 60, 60]}))["agents_falling"].value == pytest.approx(6 / 7)


def test_rows_hold_every_agent_and_the_ceilings():
    found = rows(SETTINGS, made_up())
    assert len(found) == 2 * (2 * len(agents_of(SETTINGS)) + 1)
    random = found[0]
    assert (random["agent"], random["mean"], random["deviation"]) == ("random", [80, 41, 0], [0, 1, 0])
    assert found[-1]["ceiling"] == [1.0, 0.6, 0.0]


def test_full_size_is_the_thesiss():
    assert (FULL["tasks"], FULL["max_steps"], FULL["kappas"][0]) == (10, 1000, 0.0)


@pytest.mark.parametrize(
    ("overrides", "rule"),
    [
        ({"kappas": "[0.5, 1.0]"}, "kappas must rise from 0"),
        ({"kappas": "[0.0, 1.0]"}, "contain kappa"),
        ({"snapshots": "[5, 1]"}, "snapshots must be rising"),
        ({"default": '{"loops": 0.1, "experts": "walks"}'}, "whether agents heed"),
    ],
)
def test_settings_that_limits_cannot_describe(overrides, rule):
    with pytest.raises(InputError, match=rule):
        CLAIM.settings("quick", overrides)
