"""The belief about blocked places: raised by refusals, lowered by passes, forgotten by age, and by the hour."""

import numpy as np
import pytest

from lifelore.agent.travel.blocked_moves import (
    BASE,
    REFUSED_IF_BLOCKED,
    REFUSED_IF_OPEN,
    STRENGTH,
    blocked_probability,
)
from lifelore.agent.travel.passes import observed
from lifelore.domains.grids.grid_world import Frame, GridWorld

MONDAY = 1_704_067_200.0
DAYS, HOURS = 86_400.0, 3_600.0
WORLD = GridWorld.from_free("building", np.ones((1, 20), np.bool_), frame=Frame(0.5))
EAST = 2


def blocked(moves, clock):
    """Probability of a refusal of the move east from state 5, after (clock, passed) of this move."""
    times, passed = (np.array(column) for column in zip(*moves, strict=True))
    n = len(times)
    rows = observed(WORLD, np.full(n, 5), np.full(n, EAST), times, np.where(passed, 1.0, np.nan))
    return blocked_probability(WORLD, rows, clock)[5, EAST]


def test_one_refusal_by_hand():
    at = MONDAY + 10 * HOURS
    # The building: one refusal beside 4 observations of 1 %; the hour: the same once more.
    building = (STRENGTH * BASE + 1) / (STRENGTH + 1)
    base = (STRENGTH * building + 1) / (STRENGTH + 1)
    after = base * REFUSED_IF_BLOCKED / (base * REFUSED_IF_BLOCKED + (1 - base) * REFUSED_IF_OPEN)
    assert blocked([(at, False)], at) == pytest.approx(after, abs=1e-6)


def test_a_pass_reopens_at_once_and_age_slowly():
    usual = [(MONDAY + day * DAYS + 10 * HOURS, True) for day in range(20)]
    bump = MONDAY + 21 * DAYS + 10 * HOURS
    fresh = blocked([*usual, (bump, False), (bump + 600, False)], bump + 1200)
    reopened = blocked([*usual, (bump, False), (bump + 600, False), (bump + 1200, True)], bump + 1800)
    week, month = (blocked([*usual, (bump, False), (bump + 600, False)], bump + days * DAYS) for days in (7, 28))
    assert fresh > 0.65  # two refusals multiply the odds by 9.8² = 96, of a base rate of some 3 %
    assert reopened < 0.2
    assert month < week < 0.6 * fresh
    assert month < 0.2  # the share of refusals at this hour


def test_a_door_that_is_closed_every_night_is_expected_to_be_open_by_day():
    moves = [(MONDAY + day * DAYS + hour * HOURS, hour < 20) for day in range(19) for hour in (8, 10, 14, 18, 22)]
    friday = MONDAY + 18 * DAYS
    assert blocked(moves, friday + 22 * HOURS + 60) > 0.9
    assert blocked(moves, MONDAY + 21 * DAYS + 22 * HOURS) > 0.6
    assert blocked(moves[:-1], friday + 22 * HOURS) > 0.6  # before this night's refusal
    assert blocked(moves, MONDAY + 21 * DAYS + 10 * HOURS) < 0.25


def test_within_a_minute_a_pass_comes_after_the_refusals():
    at = MONDAY + 10 * HOURS
    assert blocked([(at, False), (at + 10, True)], at + 60) < blocked([(at, True), (at - 120, True)], at) + 0.1


def test_other_places_and_moves_without_a_map():
    rows = observed(WORLD, [5], [EAST], [MONDAY], [np.nan])
    probability = blocked_probability(WORLD, rows, MONDAY)
    assert probability[7, 3] == probability[5, EAST]
    assert probability[10, EAST] < 0.3
    assert probability[0, 0] == 1
