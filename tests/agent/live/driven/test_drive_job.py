"""A drive finds a way around what is blocked, remembers it, and comes back to it when it opens."""

import numpy as np
import pytest

from lifelore.agent.live.driven.drive_job import DrivenJob, drive_job
from lifelore.agent.live.transitions import frame_key
from lifelore.agent.travel.travel import Travel
from lifelore.domains.buildings.busy_building import REFUSED_SECONDS, Drive
from lifelore.domains.grids.cell_numbers import BuildingGrid
from lifelore.domains.grids.grid_world import Frame, GridWorld

MONDAY, DAY = 1_704_096_000.0, 86_400.0  # 08:00
RING = np.array([[mark == "." for mark in row] for row in (".........", *[".#######."] * 9, ".........")])
"""From the left end of the upper corridor to the right one: straight on, or around by the lower corridor."""


class Ring:
    """The ring with cells of 0.5 m; moves into `closed` cells are refused."""

    def __init__(self) -> None:
        self.world = GridWorld.from_free("ring", RING, frame=Frame(0.5))
        self.travel = Travel(self.world, BuildingGrid(frame_key(self.world)))
        self.closed: list[int] = []

    def building(self, way: np.ndarray, clock: float) -> Drive:
        """A second a move, until a closed place."""
        refused = np.flatnonzero(np.isin(way[1:], self.closed))
        end = int(refused[0]) + 1 if len(refused) else len(way) - 1
        seconds = np.ones(end)
        if len(refused):
            seconds[-1] = np.nan
        actions = (self.world.neighbour[way[:end]] == way[1 : end + 1, None]).argmax(axis=1)
        return Drive(way[:end], actions, np.full(end, clock) + np.arange(end), seconds, clock + end)

    def drive(self, start: int, goal: int, clock: float) -> DrivenJob:
        travel = self.travel
        return drive_job(
            self.world, start, goal, clock, lambda now: travel.costs(now).cost, self.building, travel.observe
        )


def test_the_straight_way_is_driven():
    drive = Ring().drive(0, 8, MONDAY)
    assert drive.to_dict() == {"reached": True, "metres": 4.0, "seconds": 8.0, "refusals": 0, "replans": 0}
    assert [path.tolist() for path in drive.paths()] == [list(range(9))]


def test_a_robot_at_its_goal_drives_nowhere():
    drive = Ring().drive(3, 3, MONDAY)
    assert (drive.reached, drive.metres, drive.seconds, drive.paths()) == (True, 0.0, 0.0, [])


def test_a_blocked_passage_is_avoided_the_second_time_and_used_again_when_it_opens():
    ring = Ring()
    ring.closed = [4]
    first = ring.drive(0, 8, MONDAY)
    # Three moves, a refusal, three moves back, and 28 around.
    assert (first.reached, first.refusals, first.replans, first.metres) == (True, 1, 1, pytest.approx(17.0))
    assert first.seconds == pytest.approx(34.0 + REFUSED_SECONDS)
    second = ring.drive(0, 8, MONDAY + 600)
    assert (second.refusals, second.metres) == (0, pytest.approx(14.0))
    ring.closed = []
    weeks = [ring.drive(0, 8, MONDAY + week * 7 * DAY).metres for week in range(1, 9)]
    assert weeks[-1] == pytest.approx(4.0)


def test_without_memory_the_passage_is_tried_each_time():
    ring = Ring()
    ring.closed = [4]
    for day in range(3):
        ring.travel = Travel(ring.world, ring.travel.grid)
        assert ring.drive(0, 8, MONDAY + day * DAY).refusals == 1


def test_no_way_is_left_when_the_goal_is_blocked():
    ring = Ring()
    ring.closed = [8]
    drive = ring.drive(6, 8, MONDAY)
    assert not drive.reached
    assert drive.refusals == 1  # the place is closed, whatever way leads to it
    assert drive.paths()[0].tolist() == [6, 7]
