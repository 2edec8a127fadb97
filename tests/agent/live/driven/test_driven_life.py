"""Lives with known goals: short ways, what memory gains, and where the next job starts."""

from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.live.goals.destinations import Destination
from lifelore.agent.live.goals.job_list import Job
from lifelore.agent.live.life import Life, live
from lifelore.agent.way import way
from lifelore.domains.buildings.floor import floor_of
from lifelore.domains.buildings.occupancy_map import write_occupancy_map
from lifelore.domains.buildings.office import office_map
from lifelore.domains.worlds import WorldSettings, world_from_settings

from ..flat_settings import flat_settings


@pytest.fixture(scope="module")
def office(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("office")
    write_occupancy_map(folder / "office.yaml", office_map(0))
    return folder / "office.yaml"


def points(seed: int, n: int) -> list[tuple[float, float]]:
    """Free places of the office."""
    world, occupancy = world_from_settings(WorldSettings()), office_map(0)
    floor = floor_of(occupancy, world)
    states = np.random.default_rng(seed).choice(world.n_states, n, replace=False)
    return [(round(x, 3), round(y, 3)) for x, y in floor.metres(floor.anchors[states]).tolist()]


def jobs(*ends: tuple[float, float], times: tuple[str, ...] | None = None) -> tuple[Job, ...]:
    texts = times or (None,) * len(ends)
    return tuple(
        Job(Destination(end), time, line)
        for line, (end, time) in enumerate(zip(ends, texts, strict=True), start=2)
    )


def life_in(office: Path, tmp_path: Path, **changes) -> Life:
    memory = str(tmp_path / "life.db")
    return live(flat_settings(domain="building", map=str(office), memory=memory, **changes))


def test_a_trip_is_driven_at_once_and_about_as_long_as_the_shortest_path(office, tmp_path):
    start, goal = (3.025, 7.525), (30.975, 17.025)
    report = life_in(office, tmp_path, goal=goal, start=start, tasks=2, compare=True).report
    assert report["how"] == "driven"
    found = way(start, goal, map=office, memory=str(tmp_path / "life.db"))
    assert found.length > 28
    for task in report["tasks"]:
        assert task["how"] == "driven"
        drive = task["agents"]["lore"]
        assert drive["reached"]
        assert drive["metres"] <= 1.1 * found.length
        assert drive["metres"] == task["map_metres"]
        assert drive == task["agents"]["map only"]
        assert not any("80" in key for key in drive)


def test_drives_that_are_simulated_on_the_map_teach_no_times(office, tmp_path):
    """They would count, at the simulated speed, beside what logs of the robot teach."""
    life = life_in(office, tmp_path, goals=jobs(*points(1, 2)))
    assert life.report["tasks"][1]["agents"]["lore"]["reached"]
    assert life.building.known.any()
    assert not life.building.travel.driven.any()


def test_a_list_starts_each_job_where_the_last_one_ended(office, tmp_path):
    ends = points(1, 4)
    first = life_in(office, tmp_path, goals=jobs(*ends[1:]), start=ends[0]).report["tasks"]
    assert [task["start"] for task in first[1:]] == [task["goal"] for task in first[:-1]]
    assert [task["clock"][11:16] for task in first] == ["08:00", "08:30", "09:00"]
    again = life_in(office, tmp_path, goals=jobs(*ends[1:])).report["tasks"]
    assert again[0]["start"] == first[-1]["goal"]
    assert again[0]["clock"] == "2024-01-01T09:30:00"


def test_times_of_a_list_are_kept_and_the_next_run_is_of_the_next_day(office, tmp_path):
    timed = jobs(*points(1, 2), times=("08:15", "08:15"))
    first = life_in(office, tmp_path, goals=timed).report["tasks"]
    assert first[0]["clock"] == "2024-01-01T08:15:00"
    assert "2024-01-01T08:15:00" < first[1]["clock"] < "2024-01-01T08:20:00"  # the robot was still on its way
    assert life_in(office, tmp_path, goals=timed).report["tasks"][0]["clock"] == "2024-01-02T08:15:00"


def test_memory_saves_time_and_refusals_in_a_busy_building(office, tmp_path):
    places = points(100, 6)
    order = np.random.default_rng(2).integers(6, size=60)
    report = life_in(office, tmp_path, goals=jobs(*(places[i] for i in order)), busy=True, seed=1).report
    assert report["settings"]["busy"] is True
    compared = report["summary"]["lore_vs_map_only"]["all"]
    assert compared["refusals"]["lore"] < compared["refusals"]["map only"]
    assert compared["seconds_ratio"]["ci95"][1] < 1


def test_what_one_robot_learnt_another_one_knows(office, tmp_path):
    ends = points(100, 4)
    life_in(office, tmp_path, goals=jobs(*ends), busy=True, compare=False)
    other = life_in(office, tmp_path, goals=jobs(ends[0]), busy=True, compare=False, robot="second")
    assert other.building.travel.passes.passes.sum() > 100
    assert other.report["tasks"][0]["clock"] == "2024-01-01T10:00:00"


def test_destinations_change_nothing_where_goals_are_known(office, tmp_path):
    said: list[str] = []
    settings = flat_settings(
        domain="building",
        map=str(office),
        memory=str(tmp_path / "a.db"),
        goals=jobs(*points(1, 1)),
        destinations=5,
    )
    assert live(settings, notify=said.append).report["how"] == "driven"
    assert said == ["destinations draws hidden goals alone; these goals are known, and driven to"]
