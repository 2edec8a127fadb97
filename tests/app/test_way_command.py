"""`lifelore way`: what it prints, and the path as JSON and CSV."""

import csv
import re
from pathlib import Path

import numpy as np
import pytest

from lifelore.app.command_line import run
from lifelore.domains.buildings.occupancy_map import OccupancyMap, write_occupancy_map

JOBS = "time,name,x,y\n10:00,lab,5.05,3.05\n09:00,dock,0.55,0.55\n11:00,lab,,\n"


@pytest.fixture(scope="module")
def lived(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Options that name a room of 6 x 4 m and the memory of a life there."""
    folder = tmp_path_factory.mktemp("room")
    state = np.zeros((42, 62), np.uint8)
    state[[0, -1], :] = state[:, [0, -1]] = 1
    write_occupancy_map(folder / "room.yaml", OccupancyMap(state, 0.1))
    (folder / "jobs.csv").write_text(JOBS)
    options = ["--map", str(folder / "room.yaml"), "--memory", str(folder / "life.db")]
    assert run(["live", *options, "--tasks", "4"]) == 0  # searches, which see the whole room
    assert run(["live", *options, "--goals", str(folder / "jobs.csv")]) == 0
    return options


def test_a_person_reads_the_way(ask, lived):
    said = ask("way", *lived, "--from", "dock", "--to", "lab")
    assert (said.status, said.err) == (0, "")
    first, *poses = said.out.splitlines()
    assert re.match(r"5\.1[5-9] m from dock to lab over ", first)  # 5.15 m are the straight line
    assert "about 1" in first  # seconds, at half a metre a second
    assert (poses[0][:11], poses[-1][:11]) == ("0.550 0.550", "5.050 3.050")
    again = ask("way", *lived, "--from", "dock", "--to", "lab", "--at", "2024-05-13T08:30")
    assert again.out.startswith("5.15 m from dock to lab over ")  # what was driven in January tells little in May
    outline = ask("way", *lived, "--from", "dock", "--to", "lab", "--footprint", "[[0.3,0.2],[0.3,-0.2],[-0.3,0]]")
    assert outline.out == said.out  # there is room enough


def test_the_way_as_json_and_csv(ask, lived):
    said = ask("way", *lived, "--from", "0.55,0.55", "--to", "lab", "--json", "--csv", "way.csv", "--spacing", 0.1)
    assert (said.status, said.err) == (0, "")
    way = said.document
    assert way["header"]["frame_id"] == "map"
    assert way["from"] == {"name": None, "point": [0.55, 0.55]}
    assert way["to"] == {"name": "lab", "point": [5.05, 3.05]}
    assert np.hypot(4.5, 2.5) - 1e-9 <= way["length"] < 1.01 * np.hypot(4.5, 2.5)
    positions = [pose["pose"]["position"] for pose in way["poses"]]
    with Path("way.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["x", "y", "heading"]
    found = [(float(row["x"]), float(row["y"])) for row in rows]
    assert np.allclose(found, [(at["x"], at["y"]) for at in positions], atol=1e-4)
    ahead = np.subtract(found[1], found[0])
    assert float(rows[0]["heading"]) == pytest.approx(np.arctan2(ahead[1], ahead[0]), abs=1e-3)
    steps = np.hypot(*np.diff(found, axis=0).T)
    assert steps.max() <= 0.1 + 2e-4
    assert steps.sum() == pytest.approx(way["length"], abs=0.01)


@pytest.mark.parametrize(
    ("question", "words"),
    [
        (("--from", "dock", "--to", "cellar"), "memory knows dock, lab; give X,Y in metres"),
        (("--from", "dock", "--to", "0.05,1"), "the nearest free place is"),
        (("--from", "1,2,3", "--to", "lab"), "from must be X,Y"),
        (("--from", "dock", "--to", "lab", "--cell", "1"), "knows no moves of this building"),
        (("--from", "dock", "--to", "lab", "--csv", "no/where.csv"), "csv cannot be written to no/where.csv"),
        (("--from", "dock", "--to", "lab", "--at", "08:30"), "at must be a date and time by the robot's clock"),
        (("--from", "dock", "--to", "lab", "--at", "2024-05-13T08:30Z"), "at must be a date and time by"),
        (("--from", "dock", "--to", "lab", "--footprint", "[[1,2]]"), "footprint must be three or more corners"),
        (
            ("--from", "dock", "--to", "lab", "--footprint", "[[3,0],[-3,1],[-3,-1]]"),
            "touches an obstacle on every",
        ),
        (("--to", "lab"), "--from"),
    ],
)
def test_a_mistake_is_one_line(ask, lived, question, words):
    assert words in ask("way", *lived, *question).refusal
