"""`lifelore recognise`: what it prints, the job list that it writes, and its refusals."""

from dataclasses import replace
from pathlib import Path

import pytest

from lifelore.domains import OccupancyMap, office_map, write_occupancy_map
from tests.domains.buildings.resaved_maps import shifted

OFFICE = office_map(1, 14.0, 12.0)
DOCK, LAB = (3.68, 7.58), (13.52, 7.98)
JOBS = f"time,name,x,y\n10:00,lab,{LAB[0]},{LAB[1]}\n09:00,dock,{DOCK[0]},{DOCK[1]}\n11:00,lab,,\n"


@pytest.fixture
def maps(tmp_path: Path) -> Path:
    """A folder with an old map, a new one and a job list of the old one."""
    write_occupancy_map(tmp_path / "old.yaml", OFFICE)
    new = shifted(OFFICE, 3.0, -2.0)
    state = new.state.copy()
    state[118:123, 268:273] = 1  # on the lab
    write_occupancy_map(tmp_path / "new.yaml", replace(new, state=state))
    (tmp_path / "jobs.csv").write_text(JOBS)
    return tmp_path


def test_a_person_reads_where_the_waypoints_are(ask, maps):
    said = ask("recognise", "new.yaml", "--old", "old.yaml", "--goals", "jobs.csv", "--out", "jobs_new.csv")
    assert (said.status, said.err) == (0, "")
    walls, pose, lab, dock, wrote = said.out.splitlines()
    assert walls == "old: 99 % of the walls agree"
    assert pose == "the map lies at -3.00 m, 2.00 m in the remembered frame, turned by 0.00°"
    assert lab.startswith("lab 16.52,5.98 blocked: is occupied; the nearest free place is ")
    assert dock == "dock 6.68,5.58 free"
    assert wrote == "wrote jobs_new.csv"
    header, lab, dock, again = (maps / "jobs_new.csv").read_text().splitlines()
    assert (header, again) == ("time,name,x,y", "11:00,lab,,")
    assert dock.startswith("09:00,dock,6.6")
    assert lab.startswith("10:00,lab,16.5")


def test_what_runs_of_a_robot_taught_is_enough(ask, maps):
    """Memory that has never lived knows the building, and the names of the job list are looked up in the list."""
    (maps / "runs.csv").write_text(
        "time,x,y,outcome\n" + "".join(f"{i},{DOCK[0] + 0.1 * i:.3f},{DOCK[1]},\n" for i in range(8))
    )
    learnt = ask("learn-from", "runs.csv", "--map", "old.yaml", "--memory", "robot.db")
    assert learnt.status == 0, learnt.err
    said = ask("recognise", "new.yaml", "--memory", "robot.db", "--goals", "jobs.csv", "--json")
    assert (said.status, said.err) == (0, "")
    assert set(said.document) == {"building", "map", "pose", "walls", "waypoints"}
    assert said.document["building"] == "old"
    assert said.document["pose"] == pytest.approx([-3, 2, 0], abs=0.01)
    assert [one["state"] for one in said.document["waypoints"]] == ["blocked", "free"]
    named = ask("recognise", "new.yaml", "--memory", "robot.db")
    assert "memory knows no places by name here; give a job list (--goals)" in named.out


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("mirror.yaml", "--old", "old.yaml"), "map mirror.yaml shows a mirror image of old"),
        (("new.yaml", "--old", "no.yaml"), "map: no such file: no.yaml"),
        (("new.yaml", "--old", "old.yaml", "--goals", "no.csv"), "goals: cannot read no.csv"),
        (
            ("new.yaml", "--old", "old.yaml", "--goals", "jobs.csv", "--out", "no/j.csv"),
            "out cannot be written to no/j.csv",
        ),
        (("new.yaml", "--old", "old.yaml", "--memory", "a.db"), "old and memory exclude each other"),
        (("new.yaml", "--memory", "none.db"), "does not exist"),
    ],
)
def test_a_mistake_is_one_line(ask, maps, options, words):
    write_occupancy_map(maps / "mirror.yaml", OccupancyMap(OFFICE.state[:, ::-1].copy(), OFFICE.resolution))
    assert words in ask("recognise", *options).refusal


def test_a_memory_that_knows_no_building_says_what_to_do(ask, maps):
    ask("live", "--domain", "lattice", "--tasks", 1, "--memory", "other.db")
    assert (
        "live or learn from runs on the earlier map first"
        in ask("recognise", "new.yaml", "--memory", "other.db").refusal
    )
