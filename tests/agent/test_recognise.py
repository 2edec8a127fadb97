"""Waypoints in a map that was saved again: where they are, which are blocked, and which maps are refused."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.live.buildings.recognition import recognised_place
from lifelore.agent.live.goals.destinations import NamedPlaces
from lifelore.agent.recognise import BLOCKED, FREE, OUTSIDE, Recognition, recognise
from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.buildings.occupancy_map import (
    OCCUPIED,
    OccupancyMap,
    read_occupancy_map,
    write_occupancy_map,
)
from lifelore.domains.buildings.office import office_map
from lifelore.domains.buildings.registration import composed
from lifelore.domains.worlds import WorldSettings, world_from_settings
from lifelore.memory import open_memory
from reproduction.own.o_04_same_building.edits import cropped, noisy, refurnished, turned
from tests.domains.buildings.resaved_maps import padded, shifted

OFFICE = office_map(1, 14.0, 12.0)
PIXELS = {"dock": (128, 73), "lab": (120, 270), "store": (123, 155)}
NARROW = (35, 105)
"""Row and column of a free place each; the test of the same map sees that they are free."""


def metres(occupancy: OccupancyMap, row: int, column: int) -> tuple[float, float]:
    """The centre of a pixel of a map without yaw."""
    x, y, _ = occupancy.origin
    return x + (column + 0.5) * occupancy.resolution, y + (len(occupancy.state) - row - 0.5) * occupancy.resolution


NAMES = {name: metres(OFFICE, *pixel) for name, pixel in PIXELS.items()}


@pytest.fixture(scope="module")
def memory(tmp_path_factory) -> Path:
    """A memory that knows the office, and three places in it."""
    path = tmp_path_factory.mktemp("memory") / "robot.db"
    settings = WorldSettings(map="home.yaml")
    with open_memory(path) as opened:
        place = recognised_place(settings, world_from_settings(settings, OFFICE), OFFICE, opened)
        named = [NamedPlaces.of(place).record(name, point) for name, point in NAMES.items()]
        opened.contribute("robot", place.news + named, process="p", seq=0, task={})
    return path


@pytest.fixture
def found(memory, tmp_path):
    """A function that recognises an edit of the office."""

    def found(new: OccupancyMap, **options) -> Recognition:
        write_occupancy_map(tmp_path / "new.yaml", new)
        where = {} if "old" in options else {"memory": memory}
        return recognise(tmp_path / "new.yaml", **where, **options)

    return found


def same_ground(new: OccupancyMap, recognition: Recognition) -> float:
    """Share of a patch around each waypoint that is the same in both maps, at the waypoints' pixels."""
    alike = []
    for one in recognition.waypoints:
        patches = []
        for occupancy, (x, y) in ((OFFICE, one.before), (new, one.point)):
            x0, y0, yaw = occupancy.origin
            assert yaw == 0
            column = int((x - x0) / occupancy.resolution)
            row = len(occupancy.state) - 1 - int((y - y0) / occupancy.resolution)
            patches.append(occupancy.state[row - 12 : row + 13, column - 12 : column + 13])
        alike.append((patches[0] == patches[1]).mean())
    return float(np.mean(alike))


def test_the_same_map_has_the_same_waypoints(found):
    same = found(OFFICE)
    assert (same.building, same.pose, same.walls) == ("home", (0.0, 0.0, 0.0), 1.0)
    assert [one.name for one in same.waypoints] == sorted(NAMES)
    for one in same.waypoints:
        assert one.point == pytest.approx(NAMES[one.name or ""], abs=1e-5)
        assert (one.state, one.reason, one.nearest, one.away) == (FREE, None, None, 0.0)


@pytest.mark.parametrize(
    ("edit", "yaw"),
    [
        (padded, 0.0),
        (shifted, 0.0),
        (noisy, 0.0),
        (lambda m: noisy(turned(m, 3.0)), -3.0),
        (lambda m: turned(m, 180.0), 180.0),
        (lambda m: shifted(cropped(m, 0.9)), 0.0),
    ],
    ids=["padded", "shifted", "saved again", "3° and noise", "half a turn", "cropped and shifted"],
)
def test_waypoints_lie_on_the_same_ground_of_a_new_map(found, edit, yaw):
    new = edit(OFFICE)
    recognition = found(new)
    assert recognition.building == "home"
    assert abs(np.degrees(recognition.pose[2])) == pytest.approx(abs(yaw), abs=0.05)
    assert recognition.walls > 0.96
    for one in recognition.waypoints:
        back = composed(recognition.pose, (*one.point, 0.0))[:2]
        assert back == pytest.approx(NAMES[one.name or ""], abs=1e-4)
    if yaw == 0.0:
        assert same_ground(new, recognition) > 0.97


def test_the_pose_of_a_turned_map_is_known_by_construction(found):
    """The middle of the old picture is the middle of the turned one, to a centimetre."""
    new = turned(OFFICE, 3.0)
    recognition = found(new)
    for one in recognition.waypoints:
        arm = np.array(one.before) - np.array(OFFICE.state.shape[::-1]) * 0.05 / 2
        cos, sin = np.cos(np.radians(3.0)), np.sin(np.radians(3.0))
        middle = np.array(new.state.shape[::-1]) * 0.05 / 2
        expected = middle + np.array([cos * arm[0] - sin * arm[1], sin * arm[0] + cos * arm[1]])
        assert np.hypot(*(expected - one.point)) < 0.06  # a pixel: the turned picture is a whole number of pixels


def test_a_map_with_yaw_in_its_file(found):
    origin = (4.0, -2.0, 0.3)
    recognition = found(replace(OFFICE, origin=origin))
    for one in recognition.waypoints:
        assert one.point == pytest.approx(composed(origin, (*NAMES[one.name or ""], 0.0))[:2], abs=0.01)
        assert one.state == FREE


def test_a_waypoint_under_furniture_is_blocked(found):
    new = shifted(OFFICE)
    row, column = PIXELS["lab"]
    state = new.state.copy()
    state[row - 2 : row + 3, column - 2 : column + 3] = OCCUPIED
    dock, lab, _ = found(replace(new, state=state)).waypoints
    assert (dock.state, lab.state, lab.reason) == (FREE, BLOCKED, "is occupied")
    assert lab.nearest is not None
    # Two pixels of furniture and four of the robot's radius, and the nearest pixel beyond.
    assert 0.3 <= lab.away <= 0.36
    assert lab.away == pytest.approx(np.hypot(*np.subtract(lab.nearest, lab.point)))


def test_what_is_free_depends_on_the_robots_radius(found, tmp_path):
    """The point stands 6 pixels of 0.05 m from the nearest wall."""
    x, y = metres(OFFICE, *NARROW)
    (tmp_path / "jobs.csv").write_text(f"x,y\n{x},{y}\n")
    (small,) = found(shifted(OFFICE), goals=tmp_path / "jobs.csv", robot_radius=0.25).waypoints
    (large,) = found(shifted(OFFICE), goals=tmp_path / "jobs.csv", robot_radius=0.35).waypoints
    assert (small.state, large.state) == (FREE, BLOCKED)
    assert large.reason == "is nearer to an obstacle than the robot's radius of 0.35 m"


def test_a_waypoint_on_ground_that_was_not_mapped_is_outside(found):
    recognition = found(cropped(OFFICE, 0.7))
    columns = int(OFFICE.state.shape[1] * 0.7)
    for one in recognition.waypoints:
        assert (one.state == OUTSIDE) == (PIXELS[one.name or ""][1] >= columns)
    assert {one.state for one in recognition.waypoints} == {FREE, OUTSIDE}


@pytest.mark.parametrize(
    ("new", "words"),
    [
        (replace(OFFICE, state=OFFICE.state[:, ::-1]), "shows a mirror image of home"),
        (turned(replace(OFFICE, state=OFFICE.state[::-1]), 5.0), "shows a mirror image of home"),
        (office_map(2, 14.0, 12.0), "is not recognised: "),
    ],
    ids=["mirror", "mirror, turned", "another building"],
)
def test_what_is_not_certain_is_refused(found, new, words):
    with pytest.raises(InputError, match=words):
        found(new)


def test_a_name_decides_where_much_of_the_furniture_moved(found):
    new = turned(refurnished(OFFICE, 0.6), 3.0)
    with pytest.raises(InputError, match=r"9\d % of the walls match; .* name it \(--building\): then 75 % of"):
        found(new)
    named = found(new, building="home")
    assert 0.75 < named.walls < 0.96
    assert np.degrees(named.pose[2]) == pytest.approx(-3, abs=0.05)
    with pytest.raises(InputError, match="map does not fit building 'home'"):
        found(office_map(2, 14.0, 12.0), building="home")


def test_two_maps_with_too_little_in_common_are_refused(found, tmp_path):
    """A third of each map's ground is known to the other."""
    write_occupancy_map(tmp_path / "west.yaml", cropped(OFFICE, 0.6))
    east = replace(OFFICE, state=np.ascontiguousarray(OFFICE.state[:, int(OFFICE.state.shape[1] * 0.4) :]))
    with pytest.raises(InputError, match=r"is not recognised: .*; give a map that shows more of the building"):
        found(turned(east, 5.0), old=tmp_path / "west.yaml")


JOBS = (
    "name,Time,y,x\nlab,09:30,{lab[1]},{lab[0]}\n,08:15,{dock[1]:.2f},{dock[0]:.2f}\nstore,10:00,,\nlab,11:00,,\n"
)


def test_a_job_list_stays_as_it_is_but_for_its_coordinates(found, tmp_path):
    (tmp_path / "jobs.csv").write_text(JOBS.format(**NAMES))
    recognition = found(shifted(OFFICE, 3.0, -2.0), goals=tmp_path / "jobs.csv")
    assert [one.name for one in recognition.waypoints] == ["lab", None, "store"]
    assert recognition.waypoints[2].before == pytest.approx(NAMES["store"], abs=1e-5)
    recognition.write_jobs(tmp_path / "new.csv", tmp_path / "jobs.csv")
    with (tmp_path / "new.csv").open(newline="") as file:
        header, lab, point, store, again = csv.reader(file)
    assert header == ["name", "Time", "y", "x"]
    assert (store, again) == (["store", "10:00", "", ""], ["lab", "11:00", "", ""])
    assert lab[:2] == ["lab", "09:30"]
    assert [float(lab[3]), float(lab[2])] == pytest.approx(np.add(NAMES["lab"], (3, -2)), abs=0.01)
    assert [float(point[3]), float(point[2])] == pytest.approx(np.add(NAMES["dock"], (3, -2)), abs=0.01)


def test_without_a_job_list_the_names_become_one(found, tmp_path):
    found(OFFICE).write_jobs(tmp_path / "names.csv")
    with (tmp_path / "names.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["name"] for row in rows] == sorted(NAMES)
    assert float(rows[0]["x"]) == pytest.approx(NAMES["dock"][0], abs=0.001)


def test_two_maps_and_no_memory(found, tmp_path):
    write_occupancy_map(tmp_path / "old.yaml", OFFICE)
    (tmp_path / "jobs.csv").write_text("name,x,y\nlab,{lab[0]},{lab[1]}\n".format(**NAMES))
    recognition = found(shifted(OFFICE), old=tmp_path / "old.yaml", goals=tmp_path / "jobs.csv")
    assert recognition.building == "old"
    assert recognition.waypoints[0].point == pytest.approx(np.add(NAMES["lab"], (3.37, -1.2)), abs=0.01)
    (tmp_path / "jobs.csv").write_text("name\nlab\n")
    with pytest.raises(NotFoundError, match="no line gives the position of 'lab'"):
        found(OFFICE, old=tmp_path / "old.yaml", goals=tmp_path / "jobs.csv")
    with pytest.raises(InputError, match="old and memory exclude each other"):
        recognise(tmp_path / "old.yaml", "some.db", old=tmp_path / "old.yaml")


def test_memory_is_only_read_and_says_what_it_lacks(found, memory, tmp_path):
    before = memory.read_bytes()
    document = found(shifted(OFFICE)).to_dict()
    assert memory.read_bytes() == before
    assert read_occupancy_map(document["map"]).state.shape == OFFICE.state.shape
    with pytest.raises(NotFoundError, match="memory knows no building 'annex'; it knows home"):
        found(OFFICE, building="annex")
    with open_memory(tmp_path / "empty.db"):
        pass
    with pytest.raises(NotFoundError, match="live or learn from runs on the earlier map first"):
        recognise(tmp_path / "new.yaml", tmp_path / "empty.db")
    (tmp_path / "jobs.csv").write_text("name\nkitchen\n")
    with pytest.raises(
        NotFoundError, match="no destination of this building is named 'kitchen'; memory knows dock"
    ):
        found(OFFICE, goals=tmp_path / "jobs.csv")
