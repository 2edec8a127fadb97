"""`lifelore learn-from` on a CSV log and on a rosbag, and its refusals."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.learn_from.run_log import Run
from lifelore.domains.buildings.occupancy_map import FREE, read_occupancy_map
from lifelore.domains.worlds import make_world

from ..agent.learn_from.robot_runs import csv_text, driven_run
from ..bridges.robot_bag import ABORTED, EXECUTING, SUCCEEDED, RobotBag

MAP = Path(__file__).parents[2] / "examples" / "data" / "office.yaml"


@pytest.fixture(scope="module")
def world():
    return make_world("building", map=MAP)


def test_a_log_is_learnt_once(ask, world, tmp_path):
    Path("runs.csv").write_text(csv_text([driven_run(world, number) for number in range(3)]))
    arguments = ("learn-from", "runs.csv", "--map", MAP, "--memory", "m.db")
    said = ask(*arguments)
    assert (said.status, said.err) == (0, "")
    assert "a new building: office" in said.out
    assert "3 of 3 runs are new; 3 reached their goal" in said.out
    again = ask(*arguments, "--json").document
    assert (again["new"], again["runs"], again["building"]["recognised"]) == (0, 3, True)
    Path("runs.csv").write_text(csv_text([driven_run(world, 3, outcome="")]))
    assert ask(*arguments, "--reached-goal", "--json").document["to_goal"] == 1


def test_a_bag_with_transforms_and_goals_is_several_runs(ask, world, tmp_path):
    """The robot drives two runs; one ends at its goal, in the other it bumps and gives up."""
    pytest.importorskip("rosbags")
    first, second = driven_run(world, 1), driven_run(world, 2)
    bag, start = RobotBag(tmp_path / "bag"), 1_700_000_000.0
    bag.transform(start, "map", "odom", (10.0, 5.0, 0.0), fixed=True)
    for number, (run, begin) in enumerate([(first, start), (second, start + 1000)]):
        bag.goals(begin, {number: EXECUTING})
        for time, point in zip(run.time, run.points - (10.0, 5.0), strict=True):
            bag.transform(begin + time, "odom", "base_link", (*point, 0.0))
        bag.goals(begin + run.time[-1], {number: (SUCCEEDED, ABORTED)[number]})
    bag.pressed(start + 1000 + second.time[-3], True)
    arguments = ("learn-from", bag.write(), "--map", MAP, "--memory", tmp_path / "m.db", "--json")
    report = ask(*arguments).document
    assert (report["runs"], report["to_goal"], report["bumps"], report["clock"]) == (2, 1, 1, True)
    assert (report["outside"], report["moves"] > 5, report["warnings"]) == (0, True, [])
    assert "no poses on topic '/odom'" in ask(*arguments, "--topic", "/odom").err
    assert ask("memory", "forget", "--source", bag.path, "--memory", tmp_path / "m.db", "--json").document == {
        "forgotten": 2, "source": str(bag.path)
    }  # fmt: skip


def test_a_log_with_another_origin_is_mended_as_the_message_says(ask, world):
    runs = [driven_run(world, number) for number in range(12)]
    moved = [replace(run, points=run.points + np.array([5.0, 2.0])) for run in runs]
    Path("runs.csv").write_text(csv_text(moved))
    arguments = ("learn-from", "runs.csv", "--map", MAP, "--memory", "m.db")
    refused = ask(*arguments)
    assert (refused.status, len(refused.err.splitlines())) == (2, 1)
    option = next(word for word in refused.err.split() if word.startswith("--shift="))
    dry = ask(*arguments, option, "--dry-run")
    assert (dry.status, "dry run: nothing is stored" in dry.out, Path("m.db").exists()) == (0, True, False)
    assert "12 of 12 runs are new" in ask(*arguments, option).out


def open_at(mask: str, point) -> bool:
    """Whether nav2's mask has no keepout at a point of an unturned map."""
    keepout = read_occupancy_map(mask)
    column, up = ((np.asarray(point) - keepout.origin[:2]) / keepout.resolution).astype(int)
    return bool(keepout.state[keepout.state.shape[0] - 1 - up, column] == FREE)


def test_masks_of_last_nights_log(ask, world):
    """Ten bumps into a place that was driven through close it on the mask; passes reopen it."""
    start = 1_700_000_000.0
    driven = [replace(one, time=one.time + start) for one in (driven_run(world, number) for number in range(4))]
    path = world.states_at(driven[0].points)
    before, after = next((a, b) for a, b in pairwise(path.tolist()[30:]) if a != b)
    here, there = world.positions(np.array([before, after], np.int32))
    points, none = np.array([here, 0.6 * here + 0.4 * there]), np.full(2, np.nan)
    bumps = [Run(f"bump {k}", start + 3600 * k + np.arange(2.0), points, none, ["", "bump"]) for k in range(1, 11)]
    passes = [
        replace(one, name=f"pass {k}", time=one.time + 3600 * k) for k in range(11, 21) for one in driven[:1]
    ]
    found = []
    for name, runs in (("driven", driven), ("bumps", bumps), ("passes", passes)):
        Path(f"{name}.csv").write_text(csv_text(runs))
        report = ask(
            "learn-from", f"{name}.csv", "--map", MAP, "--memory", "m.db", "--out", name, "--json"
        ).document
        assert {"keepout.yaml", "costs.yaml"} <= set(report["files"])
        found.append(
            (open_at(f"{name}/keepout.yaml", there), open_at(f"{name}/keepout.yaml", driven[0].points[0]))
        )
    assert found == [(True, True), (False, True), (True, True)]


def test_refusals(ask, tmp_path):
    Path("runs.csv").write_text("time,x,y\n0,0,0\n")
    for arguments, words in (
        (("runs.csv",), "Missing option '--map'"),
        (("none.csv", "--map", MAP), "does not exist"),
        (("runs.csv", "--map", MAP, "--topic", "/a"), "topic applies to rosbags"),
        (("runs.csv", "--map", MAP, "--bumps", "/a"), "bumps applies to rosbags"),
        (("runs.csv", "--map", MAP, "--shift", "1,2"), "shift must be X,Y,YAW in metres and radians, got '1,2'"),
        (("runs.csv", "--map", MAP, "--shift", "1,2,nan"), "shift must be three numbers"),
        (("runs.csv", "--map", MAP, "--dry-run", "--out", "x"), "out does not apply to a dry run"),
        (("runs.csv", "--map", "none.yaml"), "no such file"),
        (("none.bag", "--map", MAP), "no such rosbag"),
    ):
        said = ask("learn-from", *arguments)
        assert said.status == 2
        assert words in said.err
        assert len(said.err.splitlines()) == 1


def test_a_folder_that_cannot_be_written_is_refused_before_anything_is_stored(ask, world):
    Path("runs.csv").write_text(csv_text([driven_run(world, 0)]))
    said = ask("learn-from", "runs.csv", "--map", MAP, "--memory", "m.db", "--out", "runs.csv")
    assert (said.status, len(said.err.splitlines())) == (2, 1)
    assert not Path("m.db").exists()
