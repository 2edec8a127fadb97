"""An interrupted job list goes on with its first unfinished job."""

from pathlib import Path
from threading import Event

import numpy as np
import pytest

from lifelore.agent.live.goals.job_list import read_jobs
from lifelore.agent.live.life import Life, live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.core.errors import InputError
from lifelore.domains.buildings.occupancy_map import OccupancyMap, write_occupancy_map
from lifelore.domains.worlds import WorldSettings
from lifelore.memory import open_memory

JOBS = "time,name,x,y\n08:00,lab,5.05,3.05\n09:00,dock,0.55,0.55\n10:00,lab,,\n11:00,,3.05,2.05\n"
NAMES = ["lab", "dock", "lab", None]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch) -> Path:
    """A room of 6 x 4 m and a job list."""
    state = np.zeros((42, 62), np.uint8)
    state[[0, -1], :] = state[:, [0, -1]] = 1
    write_occupancy_map(tmp_path / "room.yaml", OccupancyMap(state, 0.1))
    (tmp_path / "jobs.csv").write_text(JOBS)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def life(
    memory="life.db", jobs="jobs.csv", notify=None, robot="robot", progress=None, stop=None, **changes
) -> Life:
    where = MemorySettings(memory, robot)
    settings = LifeSettings(
        WorldSettings(map="room.yaml"), memory=where, goals=read_jobs(jobs), compare=False, **changes
    )
    return live(settings, notify=notify, progress=progress, stop=stop)


def names(life: Life) -> list[str | None]:
    return [task.get("name") for task in life.report["tasks"]]


def stop_after_two_jobs() -> None:
    stop = Event()
    life(stop=stop, progress=lambda done, total, label: stop.set() if done == 2 else None)


def test_a_stopped_list_goes_on_and_lives_the_same_tasks_as_an_unbroken_one(folder):
    stop_after_two_jobs()
    lines = []
    rest = life(notify=lines.append)
    assert names(rest) == NAMES[2:]
    assert lines == [
        "job list: 2 of 4 jobs were finished in an earlier run; this run goes on with job 3, "
        "--set again=true starts with the first"
    ]
    whole = life("other.db")
    assert names(whole) == NAMES
    assert rest.report["tasks"] == whole.report["tasks"][2:]


def test_a_name_means_the_point_of_the_list_also_if_memory_has_moved_it(folder):
    stop_after_two_jobs()
    (folder / "moved.csv").write_text("name,x,y\nlab,2.05,1.05\n")
    with pytest.raises(InputError, match="goals line 2: memory knows 'lab'"):
        life(jobs="moved.csv")
    life(jobs="moved.csv", move_names=True)
    assert life(move_names=True).report["tasks"][0]["position"] == [5.05, 3.05]


def test_again_another_list_or_another_robot_starts_with_the_first_job(folder):
    stop_after_two_jobs()
    (folder / "later.csv").write_text(JOBS.replace("11:00", "12:00"))
    assert names(life(jobs="later.csv")) == NAMES
    assert names(life(robot="other")) == NAMES
    lines = []
    assert names(life(again=True, notify=lines.append)) == NAMES
    assert not lines


def test_a_finished_list_starts_over(folder):
    assert names(life()) == names(life()) == NAMES
    with open_memory("life.db") as memory:
        ((_, _, about),) = memory.keys("job list")
    assert about == {"finished": 4, "jobs": 4}


def test_again_needs_a_list():
    with pytest.raises(InputError, match="again applies to a job list, got none"):
        LifeSettings(again=True)
