"""The verbs in Python: three lines each with a map's path, and mistakes that say what to do."""

from pathlib import Path

import numpy as np
import pytest

import lifelore
from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.buildings.occupancy_map import OccupancyMap, write_occupancy_map
from tests.domains.buildings.resaved_maps import shifted

JOBS = "name,x,y\ndock,0.55,0.55\nlab,5.05,3.05\n"


@pytest.fixture(scope="module")
def room(tmp_path_factory) -> Path:
    """A folder with the map of a room of 6 x 4 m, its map saved again, a job list, and a memory of the jobs."""
    folder = tmp_path_factory.mktemp("room")
    state = np.zeros((42, 62), np.uint8)
    state[[0, -1], :] = state[:, [0, -1]] = 1
    state[18:22, 30:50] = 1
    write_occupancy_map(folder / "room.yaml", OccupancyMap(state, 0.1))
    write_occupancy_map(folder / "again.yaml", shifted(OccupancyMap(state, 0.1), 1.0, 2.0))
    (folder / "jobs.csv").write_text(JOBS)
    life = lifelore.live(map=folder / "room.yaml", goals=folder / "jobs.csv", memory=folder / "room.db")
    assert len(life.report["tasks"]) == 2
    return folder


def test_live_takes_keys_or_settings(room, tmp_path):
    settings = lifelore.LifeSettings(
        lifelore.WorldSettings(map=room / "room.yaml"),
        memory=lifelore.MemorySettings(str(tmp_path / "a.db")),
        tasks=2,
    )
    by_settings = lifelore.live(settings).report
    by_keys = lifelore.live(map=room / "room.yaml", memory=tmp_path / "b.db", tasks=2).report
    assert by_settings["tasks"] == by_keys["tasks"]
    assert lifelore.live(domain="lattice", weight=0.5, tasks=1, memory=tmp_path / "c.db").report


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"taks": 3}, "no setting has the key 'taks'; near: tasks"),
        ({"settings": lifelore.LifeSettings(), "tasks": 3}, "settings holds all settings, got also tasks"),
        ({"tasks": 0}, "tasks must be a whole number from 1"),
        ({"map": "no.yaml"}, "map: no such file: no.yaml"),
        ({"goals": "no.csv"}, "goals: cannot read no.csv"),
    ],
)
def test_a_mistake_says_what_to_do(keys, words):
    with pytest.raises(InputError, match=words):
        lifelore.live(**keys)


def test_a_way_between_names_and_points(room):
    found = lifelore.way("dock", (5.05, 3.05), map=room / "room.yaml", memory=room / "room.db", spacing=0.5)
    assert found.poses[0, :2] == pytest.approx([0.55, 0.55])
    assert found.poses[-1, :2] == pytest.approx([5.05, 3.05])
    assert found.length >= np.hypot(4.5, 2.5)
    with pytest.raises(NotFoundError, match="memory knows dock, lab"):
        lifelore.way("dock", "cellar", map=room / "room.yaml", memory=room / "room.db")


def test_the_waypoints_of_a_map_that_was_saved_again(room):
    found = lifelore.recognise(room / "again.yaml", memory=room / "room.db")
    dock, lab = found.waypoints
    assert dock.point == pytest.approx((1.55, 2.55), abs=0.02)
    assert lab.point == pytest.approx((6.05, 5.05), abs=0.02)


def test_runs_from_a_file_or_from_python(room, tmp_path):
    lines = [f"{0.5 * i},{0.55 + 0.1 * i:.2f},0.55,{'goal' * (i == 40)}" for i in range(41)]
    (tmp_path / "runs.csv").write_text("\n".join(["time,x,y,outcome", *lines]) + "\n")
    where = {"map": room / "room.yaml", "memory": tmp_path / "learnt.db"}
    report = lifelore.learn_from(tmp_path / "runs.csv", **where)
    assert (report["runs"], report["new"], report["to_goal"]) == (1, 1, 1)
    from lifelore.agent.learn_from.run_log import read_runs

    assert lifelore.learn_from(read_runs(tmp_path / "runs.csv"), **where, reached_goal=True)["new"] == 0
    assert lifelore.recognise(room / "again.yaml", memory=where["memory"]).building == "room"


def test_a_bag_is_learnt_in_one_line(tmp_path):
    pytest.importorskip("rosbags")
    data = Path(__file__).parents[1] / "examples" / "data"
    where = {"map": data / "office.yaml", "memory": tmp_path / "night.db"}
    tried = lifelore.learn_from(data / "night.mcap", **where, dry_run=True)
    learnt = lifelore.learn_from(data / "night.mcap", **where)
    assert (tried["runs"], tried["bumps"], learnt["new"]) == (10, 3, 10)
    with pytest.raises(InputError, match="topic applies to rosbags"):
        lifelore.learn_from(data / "runs.csv", **where, topic="/tf")
