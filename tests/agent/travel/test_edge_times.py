"""Typical seconds: shrinkage by hand, and what each level is for."""

import numpy as np
import pytest

from lifelore.agent.travel.edge_times import DAY, hour_of, smoothed_hours, typical_seconds
from lifelore.agent.travel.passes import observed
from lifelore.domains.grids.grid_world import Frame, GridWorld

MONDAY = 1_704_067_200.0  # 2024-01-01
DAYS, HOURS = 86_400.0, 3_600.0
WORLD = GridWorld.from_free("building", np.ones((1, 40), np.bool_), frame=Frame(0.5))
EAST = 2


def passes_of(*moves):
    """Rows of (state, clock, seconds) driven east."""
    state, clock, seconds = (np.array(column) for column in zip(*moves, strict=True))
    return observed(WORLD, state, np.full(len(state), EAST), clock, seconds)


def test_hours_of_weekdays_and_of_weekends():
    minutes = ((MONDAY + np.array([0, 9.5 * HOURS, 5 * DAYS, 6 * DAYS + 23 * HOURS, 7 * DAYS])) // 60).astype(int)
    assert hour_of(minutes).tolist() == [0, 9, 24, 47, 0]
    assert DAY == 1440


def test_hours_are_smoothed_around_the_clock():
    table = np.zeros((1, 48))
    table[0, 23] = 2.0
    smooth = smoothed_hours(table)[0]
    assert smooth[[22, 23, 0]].tolist() == [1, 2, 1]
    assert smooth.sum() == 4  # nothing leaks into the weekend


def test_where_nothing_was_seen_the_pace_of_the_building_counts():
    rows = passes_of(*((state, MONDAY + state, 2.0) for state in range(30)))
    seconds = typical_seconds(WORLD, rows, MONDAY + HOURS)
    # log 2 of 30 passes, and one pass of the nominal second.
    assert seconds[38, EAST] == pytest.approx(2 ** (30 / 31), rel=0.01)
    assert seconds[10, EAST] == pytest.approx(2.0, rel=0.02)


def test_a_slow_place_is_slow_and_one_pass_counts_less_than_many():
    usual = [(state, MONDAY + 60.0 * state + day * DAYS, 1.0) for state in range(30) for day in range(10)]
    now = MONDAY + 10 * DAYS
    many = typical_seconds(WORLD, passes_of(*usual, *((35, now - 60.0 * n, 3.0) for n in range(1, 20))), now)
    one = typical_seconds(WORLD, passes_of(*usual, (35, now - 60.0, 3.0)), now)
    assert 2.0 < many[35, EAST] < 3.1
    assert 1.0 < one[35, EAST] < many[35, EAST]
    assert many[37, 3] == many[35, EAST]  # the same cell from the other side
    assert many[5, EAST] == pytest.approx(1.0, rel=0.1)


def test_rush_hours_are_learnt_and_stay_in_their_hours():
    moves = []
    for day in range(19):
        weekend = day % 7 >= 5
        for hour in range(6, 20):
            slow = 2.0 if 8 <= hour < 11 and not weekend else 1.0
            moves += [(state, MONDAY + day * DAYS + hour * HOURS, slow) for state in range(10, 15)]
            moves += [(state, MONDAY + day * DAYS + hour * HOURS, 1.0) for state in range(25, 30)]
    rows = passes_of(*moves)

    def at(day, hour):
        return typical_seconds(WORLD, rows, MONDAY + day * DAYS + hour * HOURS)

    friday, saturday = at(18, 9.5), at(19, 9.5)
    assert friday[12, EAST] > 1.6
    assert at(18, 15.5)[12, EAST] < 1.2
    assert saturday[12, EAST] < 1.4
    assert friday[27, EAST] < 1.2


def test_a_corridor_that_became_slow_is_noticed_within_days():
    days = [(day, MONDAY + day * DAYS + 12 * HOURS) for day in range(34)]
    moves = [(state, noon, 1.0 if day < 30 else 2.5) for state in range(10, 15) for day, noon in days]
    moves += [(state, noon, 1.0) for state in range(25, 30) for _, noon in days]
    seconds = typical_seconds(WORLD, passes_of(*moves), MONDAY + 34 * DAYS + 12 * HOURS)
    mean = np.exp((4 * np.log(2.5)) / 34)
    assert seconds[12, EAST] > 1.7 > mean
    assert seconds[27, EAST] < 1.2


def test_one_long_wait_makes_no_slow_corridor():
    moves = [(state, MONDAY + day * DAYS, 1.0) for state in range(10, 15) for day in range(10)]
    seconds = typical_seconds(WORLD, passes_of(*moves, (12, MONDAY + 9 * DAYS, 3600.0)), MONDAY + 9 * DAYS)
    assert seconds[12, EAST] < 1.5
