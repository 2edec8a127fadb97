"""Jobs start in working time, at the times of their list, and never before the robot is free."""

from datetime import UTC, datetime

import pytest

from lifelore.agent.live.buildings.recognition import Place
from lifelore.agent.live.driven.robot_clock import BEGIN, RobotClock, clock_text, job_start, list_day, next_start
from lifelore.agent.live.transitions import BuildingGrid
from lifelore.domains.worlds import WorldSettings, world_from_settings
from lifelore.memory import open_memory


def at(text: str) -> float:
    return datetime.fromisoformat(text).replace(tzinfo=UTC).timestamp()


@pytest.mark.parametrize(
    ("clock", "start"),
    [
        ("2024-01-01T00:00", "2024-01-01T08:00"),
        ("2024-01-01T08:00:01", "2024-01-01T08:30"),
        ("2024-01-01T17:31", "2024-01-02T08:00"),
        ("2024-01-05T18:00", "2024-01-08T08:00"),
    ],
    ids=["first", "half hour", "evening", "weekend"],
)
def test_jobs_without_times_start_every_half_hour_of_working_time(clock, start):
    assert next_start(at(clock)) == at(start)


@pytest.mark.parametrize(
    ("clock", "first", "day"),
    [
        ("2024-01-01T00:00", "09:00", "2024-01-01"),
        ("2024-01-01T09:00:01", "09:00", "2024-01-02"),
        ("2024-01-05T12:00", "09:00", "2024-01-08"),
        ("2024-01-05T12:00", "50400", "2024-01-05"),
        ("2024-01-06T12:00", "2024-03-01T10:00", "2024-01-08"),
    ],
    ids=["first", "next day", "weekend", "seconds", "date"],
)
def test_a_list_starts_on_the_first_working_day_that_has_its_first_time_ahead(clock, first, day):
    assert list_day(at(clock), first) == at(day)


def test_times_of_a_list_are_of_its_day_or_dates():
    assert job_start("09:30", BEGIN) == at("2024-01-01T09:30")
    assert job_start("600", BEGIN) == BEGIN + 600
    assert job_start("2024-03-01T10:00", BEGIN) == at("2024-03-01T10:00")
    assert job_start("2024-03-01T10:00+01:00", BEGIN) == at("2024-03-01T09:00")
    assert clock_text(job_start("09:30:15", BEGIN)) == "2024-01-01T09:30:15"


def test_a_robot_stands_nowhere_in_cells_of_another_size(tmp_path):
    office = {cell: world_from_settings(WorldSettings("building", cell=cell)) for cell in (0.5, 0.6)}
    places = {cell: Place(world, BuildingGrid("frame", building="b")) for cell, world in office.items()}
    with open_memory(tmp_path / "memory.db") as memory:
        news = RobotClock("b/rosie").at(BEGIN + 60, 700).record(places[0.5])
        memory.contribute("rosie", [news], process="p", seq=0, task={})
        clocks = {cell: RobotClock.recalled(place, "rosie", memory) for cell, place in places.items()}
    assert {clock.clock for clock in clocks.values()} == {BEGIN + 60}
    assert [clock.state for clock in clocks.values()] == [700, None]
