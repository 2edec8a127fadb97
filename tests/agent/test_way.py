"""Ways over the map's free space, by the times and refusals that memory holds, and clear of obstacles."""

import math
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.live.buildings.recognition import recognised_place
from lifelore.agent.live.buildings.remembered_moves import remembered_record
from lifelore.agent.live.goals.destinations import Destination
from lifelore.agent.live.goals.job_list import Job
from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.agent.live.transitions import from_record, model_table, to_record
from lifelore.agent.travel import Travel
from lifelore.agent.way import Way, path_message, poses_along, way
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.core.learning.known_world import unknown_world
from lifelore.domains.buildings.floor import floor_of
from lifelore.domains.buildings.occupancy_map import UNKNOWN, OccupancyMap, read_occupancy_map, write_occupancy_map
from lifelore.domains.buildings.office import office_map
from lifelore.domains.worlds import WorldSettings, map_from_settings, world_from_settings
from lifelore.memory import open_memory

LEFT, RIGHT = Destination((1.25, 1.25)), Destination((10.75, 1.25))


def two_rooms(folder: Path, name: str, doors: tuple[int, ...]) -> str:
    """Two rooms of 6 x 6 m side by side, joined by doors 1 m wide from these rows on."""
    state = np.zeros((62, 121), np.uint8)
    state[[0, -1], :] = state[:, [0, -1]] = state[:, 60] = 1
    for door in doors:
        state[door : door + 10, 60] = 0
    write_occupancy_map(folder / f"{name}.yaml", OccupancyMap(state, 0.1))
    return str(folder / f"{name}.yaml")


def remember(folder: Path, map: str, forget=None) -> str:
    """A memory with all true moves of a building, changed by `forget(model, x, y)`."""
    world = world_from_settings(WorldSettings(map=map))
    model = unknown_world(world.n_states, 4)
    model.target[:] = np.where(world.neighbour < 0, np.arange(world.n_states)[:, None], world.neighbour)
    model.percept[:] = world.percepts
    if forget is not None:
        forget(model, *world.positions(np.arange(world.n_states)).T)
    path = folder / f"{0 if forget is None else forget.__name__}.db"
    with open_memory(path) as memory:
        record = to_record(world, model_table(world, model), -1)
        memory.contribute("robot", [record], process="p", seq=0, task={})
    return str(path)


MONDAY_8 = 1_704_096_000.0
"""2024-01-01 08:00 by the robot's clock."""


def observe(map: str, memory: str, clock: float, seconds: float, n=6, everywhere=False, y_range=(0, 2)) -> None:
    """Remember `n` moves, ten minutes apart, of the cells at the bottom door, or between all known cells."""
    settings = WorldSettings(map=map)
    with open_memory(memory) as opened:
        occupancy = map_from_settings(settings)
        place = recognised_place(settings, world_from_settings(settings, occupancy), occupancy, opened)
        travel = Travel.recalled(place.world, place.grid, opened)
        x, y = place.world.positions(np.arange(place.world.n_states)).T
        chosen, to = (x > 5.5) & (x < 6.5) & (y > y_range[0]) & (y < y_range[1]), place.world.neighbour
        if everywhere:
            chosen = from_record(place.world, remembered_record(place, opened)).percept >= 0
        state, action = np.nonzero(chosen[:, None] & (to >= 0) & (chosen[to] | (not everywhere)))
        when = clock + 600 * np.repeat(np.arange(n), len(state))
        travel.observe(np.tile(state, n), np.tile(action, n), when, np.full(len(when), seconds))
        opened.contribute("robot", [*place.news, *travel.news()], process=str(clock), seq=1, task={})


def find(map: str, memory: str, start=LEFT, goal=RIGHT, **options) -> Way:
    return way(start, goal, map=map, memory=memory, **options)


def test_a_way_leads_through_the_door(tmp_path):
    rooms = two_rooms(tmp_path, "rooms", (2,))  # at the top: y from 5.0 to 6.0 m
    found = find(rooms, remember(tmp_path, rooms))
    assert np.allclose(found.poses[[0, -1], :2], [LEFT.point, RIGHT.point])
    crossing = np.flatnonzero(np.diff(found.poses[:, 0] > 6.05))
    assert len(crossing) == 1
    assert 5.0 < found.poses[crossing[0], 1] < 6.0
    assert len(found.contradicted) == 0
    # Two straight lines by way of the door's corner (6.05, 5.0 + radius) are a lower bound.
    bound = np.hypot(6.05 - 1.25, 5.2 - 1.25) * 2 - 0.2
    assert bound < found.length < bound * 1.03


@pytest.mark.parametrize(("lived", "asks"), [(0.2, 0.3), (0.3, 0.2)])
def test_a_robot_of_another_radius_finds_a_way(tmp_path, lived, asks):
    """A door of 1 m lets both through; what the other has learnt serves where this robot's map has the move."""
    rooms, memory = two_rooms(tmp_path, "rooms", (2,)), MemorySettings(str(tmp_path / "life.db"))
    settings = LifeSettings(WorldSettings(map=rooms, robot_radius=lived), memory=memory, tasks=6, compare=False)
    live(settings)
    found = way(LEFT, RIGHT, map=rooms, robot_radius=asks, memory=memory.location)
    assert np.abs(np.diff(found.poses[:, 0] > 6.05)).sum() == 1
    occupancy = read_occupancy_map(rooms)
    floor = floor_of(occupancy, world_from_settings(WorldSettings(map=rooms, robot_radius=asks), occupancy))
    row, column = np.rint(floor.pixels(poses_along(found.poses[:, :2], 0.1)[:, :2])).astype(int).T
    nearest = floor.distance[row, column].min() * occupancy.resolution
    assert nearest > asks - 0.1  # half a pixel's diagonal and more


def never_driven(x0: float, x1: float, y0: float, y1: float):
    """Memory knows no place with x from x0 to x1 and y from y0 to y1."""

    def forget(model, x, y):
        gone = (x > x0) & (x < x1) & (y > y0) & (y < y1)
        model.target[gone], model.percept[gone] = -1, -1
        model.target[np.isin(model.target, np.flatnonzero(gone))] = -1

    return forget


def test_ground_that_was_never_driven_is_used_where_it_saves_more_than_its_price(tmp_path):
    """Two metres at the bottom door were never driven; that way is shorter by 6 m, then by 0.3 m."""
    rooms = two_rooms(tmp_path, "rooms", (2, 45))
    memory = remember(tmp_path, rooms, never_driven(5.0, 7.0, 0.0, 2.0))
    straight = find(rooms, memory)
    assert straight.length == pytest.approx(9.5, rel=0.02)
    assert straight.undriven == 4
    left, right = Destination((1.25, 3.0)), Destination((10.75, 3.0))
    around = find(rooms, memory, left, right)
    assert around.poses[:, 1].max() > 5.0
    assert around.undriven == 0
    bottom = find(rooms, remember(tmp_path, rooms), left, right)
    assert bottom.poses[:, 1].min() < 1.8
    assert bottom.length < around.length < bottom.length + 0.5 * 2


def test_a_door_that_was_refused_is_avoided_until_it_is_passed(tmp_path):
    rooms = two_rooms(tmp_path, "rooms", (2, 45))
    memory = remember(tmp_path, rooms)
    near = find(rooms, memory)
    assert near.poses[:, 1].max() < 2.0
    observe(rooms, memory, MONDAY_8 - 86_400, 1.0, everywhere=True)
    observe(rooms, memory, MONDAY_8, float("nan"))
    around = find(rooms, memory, clock=MONDAY_8 + 3600)
    assert around.poses[:, 1].max() > 5.0
    # The newest drive in memory is the default.
    assert np.array_equal(find(rooms, memory).poses, around.poses)
    observe(rooms, memory, MONDAY_8 + 7200, 1.0, 20)
    assert find(rooms, memory).poses[:, 1].max() < 2.5


def test_undriven_ground_beside_a_refused_place_is_avoided_too(tmp_path):
    """What blocks the lower half of a wide door probably blocks its upper half, where no robot has driven."""
    rooms = two_rooms(tmp_path, "rooms", (2, 35, 45))  # below: y from 0.7 to 2.7 m
    memory = remember(tmp_path, rooms, never_driven(5.0, 7.0, 1.5, 4.0))
    observe(rooms, memory, MONDAY_8 - 86_400, 1.0, everywhere=True)
    assert find(rooms, memory).poses[:, 1].max() < 3.0
    observe(rooms, memory, MONDAY_8, float("nan"), y_range=(0, 1.5))
    assert find(rooms, memory).poses[:, 1].max() > 5.0


def test_ground_beside_a_refused_place_is_avoided_until_a_robot_passes_there(tmp_path):
    """A wide door was driven in both halves, then closed: a robot was refused in one half alone."""
    rooms = two_rooms(tmp_path, "rooms", (2, 35, 45))
    memory = remember(tmp_path, rooms)
    observe(rooms, memory, MONDAY_8 - 86_400, 1.0, everywhere=True)
    observe(rooms, memory, MONDAY_8, float("nan"), y_range=(0, 1.5))
    assert find(rooms, memory).poses[:, 1].max() > 5.0
    observe(rooms, memory, MONDAY_8 + 7200, 1.0, 20, y_range=(1.5, 3))
    assert find(rooms, memory).poses[:, 1].max() < 3.0


def test_a_slow_door_is_avoided_where_the_way_around_takes_less_time(tmp_path):
    rooms = two_rooms(tmp_path, "rooms", (2, 45))
    memory = remember(tmp_path, rooms)
    near = find(rooms, memory)
    assert near.seconds == pytest.approx(near.length / 0.5, rel=0.01)  # half a metre a second until observed
    observe(rooms, memory, MONDAY_8 - 86_400, 1.0, everywhere=True)
    observe(rooms, memory, MONDAY_8, 2.0)
    slow = find(rooms, memory)
    assert slow.length == pytest.approx(near.length, rel=0.05)
    assert near.seconds < slow.seconds
    observe(rooms, memory, MONDAY_8 + 7200, 60.0, 40)
    assert find(rooms, memory).poses[:, 1].max() > 5.0


def test_a_closed_door_contradicts_the_remembered_way(tmp_path):
    before, after = two_rooms(tmp_path, "before", (2, 45)), two_rooms(tmp_path, "after", (2,))
    memory = remember(tmp_path, before)
    around = find(after, memory)
    assert around.poses[:, 1].max() > 5.0
    assert len(around.contradicted) >= 1
    x, y = around.contradicted[0]
    assert abs(x - 6.05) < 0.6
    assert 0.6 < y < 1.7
    closed = two_rooms(tmp_path, "closed", ())
    with pytest.raises(NotFoundError):  # each room alone is a building of its own
        find(closed, memory)


def test_a_door_that_moved(tmp_path):
    """The remembered way is straight at the bottom; the map, written anew, has the door at the other end alone."""
    rooms = two_rooms(tmp_path, "rooms", (45,))
    memory = remember(tmp_path, rooms)
    assert find(rooms, memory).poses[:, 1].max() < 2.0
    around = find(two_rooms(tmp_path, "rooms", (2,)), memory)
    assert around.poses[:, 1].max() > 5.0
    assert np.all(np.abs(around.contradicted[:, 0] - 6.05) < 0.6)
    assert np.all(around.contradicted[:, 1] < 1.7)


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"start": Destination((0.1, 0.1))}, InputError, "from must be a free place"),
        ({"goal": Destination((99.0, 0.1))}, InputError, "to must be a free place"),
        ({"goal": Destination(name="lab")}, NotFoundError, "to: no destination of this building is named 'lab'"),
        ({"spacing": 0.0}, InputError, "spacing must be a positive number of metres"),
        ({"spacing": float("nan")}, InputError, "spacing must be a positive number of metres"),
    ],
)
def test_questions_that_break_a_rule(tmp_path, options, error, words):
    rooms = two_rooms(tmp_path, "rooms", (2,))
    with pytest.raises(error, match=words):
        find(rooms, remember(tmp_path, rooms), **options)


def test_a_map_that_was_saved_again_has_the_same_names_and_ways(tmp_path):
    """Padded on the left and shifted: the same spot has other coordinates."""
    first, memory, map = office_map(5, 14.0, 12.0), str(tmp_path / "life.db"), tmp_path / "office.yaml"
    again = np.pad(first.state, ((7, 3), (13, 0)), constant_values=UNKNOWN)
    write_occupancy_map(map, first)
    write_occupancy_map(tmp_path / "again.yaml", OccupancyMap(again, first.resolution, (4.0, -2.5, 0.0)))
    floor = floor_of(first, world_from_settings(WorldSettings(map=map)))
    ends = [tuple(point) for point in floor.metres(floor.anchors[[0, -1]]).round(3).tolist()]
    jobs = (Job(Destination(ends[0], "north")), Job(Destination(ends[1], "south"))) * 2
    live(LifeSettings(WorldSettings(map=map), memory=MemorySettings(memory), goals=jobs))
    north, south = Destination(name="north"), Destination(name="south")
    before, after = (find(str(one), memory, north, south) for one in (map, tmp_path / "again.yaml"))
    assert (before.start, before.goal) == (jobs[0].destination, jobs[1].destination)
    shift = np.array([4.0 + 13 * first.resolution, -2.5 + 3 * first.resolution])
    assert np.allclose(after.poses[[0, -1], :2], before.poses[[0, -1], :2] + shift, atol=0.1)
    assert after.length == pytest.approx(before.length, abs=0.5)


def test_another_building_or_no_memory(tmp_path):
    rooms = two_rooms(tmp_path, "rooms", (2,))
    memory = remember(tmp_path, rooms)
    with pytest.raises(NotFoundError, match=r"knows no moves of this building with cell 0.25, min_free"):
        way(LEFT, RIGHT, map=rooms, cell=0.25, memory=memory)
    with pytest.raises(NotFoundError, match="knows no moves of this building"):
        way(LEFT, RIGHT, seed=3, memory=memory)
    with pytest.raises(StoreError, match="does not exist"):
        find(rooms, str(tmp_path / "none.db"))


def test_poses_lie_on_the_path_at_equal_distances_and_look_ahead():
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.5]])
    assert poses_along(corners).tolist() == [[0, 0, 0], [1, 0, math.pi / 2], [1, 0.5, math.pi / 2]]
    poses = poses_along(corners, 0.3)
    assert np.allclose(poses[:, 0], [0, 0.25, 0.5, 0.75, 1, 1, 1])
    assert np.allclose(poses[:, 1], [0, 0, 0, 0, 0, 0.25, 0.5])
    assert np.allclose(poses[:, 2], [0, 0, 0, 0] + [math.pi / 2] * 3)
    assert poses_along(corners[:1]).tolist() == [[0, 0, 0]]
    assert len(poses_along(corners, 0.5)) == 4


def test_the_message_has_the_shape_of_a_path():
    message = path_message(np.array([[1.0, 2.0, math.pi / 2]]))
    assert set(message) == {"header", "poses"}
    assert message["header"] == {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": "map"}
    (stamped,) = message["poses"]
    assert stamped["header"] == message["header"]
    assert stamped["pose"]["position"] == {"x": 1.0, "y": 2.0, "z": 0.0}
    half = math.sqrt(0.5)  # a quarter turn about z
    assert stamped["pose"]["orientation"] == pytest.approx({"x": 0.0, "y": 0.0, "z": half, "w": half})


@pytest.mark.parametrize("place", [3, None, (1.0,), (1.0, 2.0, 3.0), ("a", "b")])
def test_a_place_is_a_name_or_two_numbers(place):
    with pytest.raises(InputError, match="a place must be a name or two numbers"):
        way(place, LEFT, memory="none.db")
