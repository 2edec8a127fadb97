"""`way`: a path in metres between two places of a building, by the times and refusals that memory holds."""

import csv
import math
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import lru_cache
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.building_record import map_digest
from lifelore.agent.live import transitions
from lifelore.agent.live.buildings.recognition import kept_world, recognised_place
from lifelore.agent.live.buildings.remembered_moves import contradicted_moves, remembered_record
from lifelore.agent.live.goals.destinations import Destination, NamedPlaces, Point
from lifelore.agent.travel import Travel
from lifelore.agent.travel.move_costs import DETOUR
from lifelore.core.atomic_write import refused_writes
from lifelore.core.errors import InputError
from lifelore.domains.buildings.clear_path import clear_path
from lifelore.domains.buildings.floor import Floor, floor_of
from lifelore.domains.buildings.footprint import Footprint, footprint_path
from lifelore.domains.buildings.occupancy_map import OccupancyMap
from lifelore.domains.worlds import WorldSettings, map_from_settings
from lifelore.memory import open_memory

UNDRIVEN = 0.5
"""Metres that a metre costs beyond its length on ground that memory does not know; more makes longer detours over
known ground."""

_LAST: dict[tuple[str, str], OccupancyMap] = {}
"""The last map, by source and digest. What is made of it stays, so that further ways on a big map take a third."""
_kept_floor = lru_cache(maxsize=2)(floor_of)


@dataclass(frozen=True, eq=False)
class Way:
    """A path from one destination to another.

    start, goal : the destinations, with their points
    poses : (n, 3) x and y in metres of the map's frame, and the heading in radians
    places : number of cells that the path passes, those of its ends included
    undriven : number of these cells that memory does not know
    seconds : expected time of the drive
    contradicted : (n, 2) points of remembered moves that would make the way shorter, but that the map lacks
    """

    start: Destination
    goal: Destination
    poses: NDArray[np.float64]
    places: int
    undriven: int
    seconds: float
    contradicted: NDArray[np.float64]

    @property
    def length(self) -> float:
        """Length of the path in metres."""
        return float(np.hypot(*np.diff(self.poses[:, :2], axis=0).T).sum())

    def to_dict(self) -> dict:
        """JSON data with the keys of ``nav_msgs/Path`` (``header``, ``poses``) and further keys about the way."""
        return path_message(self.poses) | {
            "from": {"name": self.start.name, "point": list(self.start.point or ())},
            "to": {"name": self.goal.name, "point": list(self.goal.point or ())},
            "length": self.length,
            "seconds": self.seconds,
            "places": self.places,
            "undriven": self.undriven,
            "contradicted": self.contradicted.tolist(),
        }


def way(
    start: Destination | Point | str,
    goal: Destination | Point | str,
    *,
    map: str | Path | None = None,
    memory: str | Path | None = None,
    cell: float | None = None,
    robot_radius: float | None = None,
    seed: int = 0,
    spacing: float | None = None,
    building: str | None = None,
    clock: float | None = None,
    footprint: Footprint | None = None,
) -> Way:
    """The quickest path from one place of a building to another by what memory knows, clear of obstacles.

    It leads over the map's free space, keeps the robot's radius from all else, and turns at any angle. It costs
    its length, and what memory knows about its moves: where they took longer or were refused, the path leads
    around if that is expected to take less time (``MoveCosts.cost``). A metre on ground that memory does not know
    costs `UNDRIVEN` metres more. A place beside one that is probably blocked counts as blocked, too, until a robot
    passes there, since what blocks is often wider.

    Parameters
    ----------
    start, goal : str, (x, y) or Destination
        Names that memory knows, or metres of the map's frame.
    map : str or Path, optional
        YAML of the ROS map; None: the generated office of `seed`.
    memory : str or Path, optional
        SQLite file or URL; None: the user's own. It is only read.
    cell, robot_radius : float, optional
        Metres, as in the life or the runs from which memory learnt.
    seed : int
        Of the generated office.
    spacing : float, optional
        Metres: largest distance between two poses; None: only the corners of the path.
    building : str, optional
        Name of the building; None: recognise it.
    clock : float, optional
        Time of the drive in seconds since 1970 by the robot's clock; None: that of the newest drive in memory.
    footprint : Footprint, optional
        Outline that touches nothing on the path; None: a disc of the robot's radius.

    Raises
    ------
    NotFoundError
        Memory knows not the building, or not the name; or the footprint does not pass.
    InputError
        A setting or the map breaks its rule, or a point is no free place.
    StoreError
        Memory cannot be read.

    Examples
    --------
    >>> way("dock", (12.5, 3.0), map="depot.yaml", memory="depot.db").length  # doctest: +SKIP
    36.5
    """
    if spacing is not None and not (math.isfinite(spacing) and spacing > 0):
        raise InputError(f"spacing must be a positive number of metres, got {spacing}")
    begin, end = Destination.of(start), Destination.of(goal)
    world = WorldSettings("building", map, cell=cell, robot_radius=robot_radius, seed=seed)
    occupancy = _map_of(world)
    with open_memory(memory, read_only=True) as opened:
        place = recognised_place(world, kept_world(world, occupancy), occupancy, opened, building)
        record, names = remembered_record(place, opened), NamedPlaces.of(place)
        begin = names.located("from", begin, opened)
        end = names.located("to", end, opened)
        travel = Travel.recalled(place.world, place.grid, opened)
    floor = _kept_floor(place.occupancy or occupancy, place.world)
    ends = begin.located_point, end.located_point
    first, last = floor.state_at("from", ends[0]), floor.state_at("to", ends[1])
    known = (transitions.from_record(place.world, record, place.grid.corner).percept >= 0) | travel.driven
    costs, cell = travel.costs(travel.newest if clock is None else clock), place.world.frame.cell
    cost = costs.cost + np.where(travel.shut_off(costs.closed())[place.world.neighbour], DETOUR, 0.0)
    price = price_of_moves(cost, cell) + np.where(known[place.world.neighbour], 0.0, UNDRIVEN * cell)
    path = footprint_path(floor, *ends, footprint, price) if footprint else clear_path(floor, *ends, price)
    assert path is not None, "the places of a floor are joined"
    passed, seconds = _driven(path, floor, costs.seconds / cell)
    contradicted = contradicted_moves(place, record, first, last)
    poses = poses_along(path, spacing)
    return Way(begin, end, poses, len(passed), int((~known[passed]).sum()), seconds, contradicted)


def _map_of(settings: WorldSettings) -> OccupancyMap:
    """The map of a world; the same object as at the last call if the map is the same."""
    occupancy = map_from_settings(settings)
    key = occupancy.source, map_digest(occupancy)
    if key not in _LAST:
        _LAST.clear()
    return _LAST.setdefault(key, occupancy)


def clock_from_text(text: str) -> float:
    """Seconds since 1970 of a date and time without a time zone, by the robot's clock.

    Raises
    ------
    InputError
        The text is no date and time, or has a time zone.
    """
    try:
        time = datetime.fromisoformat(text)
    except ValueError:
        time = None
    if time is None or time.tzinfo is not None or time.year < 1970:
        raise InputError(f"at must be a date and time by the robot's clock, as 2024-05-13T08:30, got {text!r}")
    return time.replace(tzinfo=UTC).timestamp()


def price_of_moves(cost: NDArray[np.float64], cell: float) -> NDArray[np.float64]:
    """Metres (n_states, 4) that each move costs beyond its length, from the seconds that it costs.

    The cheapest tenth of the moves has price 0. A move of twice the seconds that divide them from the others has a
    price of `cell` metres.
    """
    cheap = np.quantile(cost[np.isfinite(cost)], 0.1) if np.isfinite(cost).any() else 1.0
    return cell * np.maximum(cost / cheap - 1, 0)


def _driven(
    path: NDArray[np.float64], floor: Floor, slowness: NDArray[np.float64]
) -> tuple[NDArray[np.int32], float]:
    """The states on a path, each once, and its expected seconds; `slowness` (n_states, 4) in seconds a metre."""
    pixels = floor.pixels(poses_along(path, floor.occupancy.resolution / 2)[:, :2])
    step, middle = np.diff(pixels, axis=0), (pixels[1:] + pixels[:-1]) / 2
    states = floor.state[tuple(np.rint(np.vstack([pixels[:1], middle, pixels[-1:]])).astype(int).T)]
    down, right = step.T
    at, length = states[1:-1], np.hypot(down, right)
    # In time, a step at an angle counts as its share along each axis.
    vertical, horizontal = slowness[at, np.where(down > 0, 1, 0)], slowness[at, np.where(right > 0, 2, 3)]
    seconds = (down**2 * vertical + right**2 * horizontal) / np.where(length > 0, length, 1)
    return np.unique(states), float(seconds.sum() * floor.occupancy.resolution)


def poses_along(path: NDArray[np.float64], spacing: float | None = None) -> NDArray[np.float64]:
    """Poses (m, 3) along a path of corners (n, 2): x, y and the heading towards the next pose in radians.

    Between two corners lie as many poses as `spacing` asks for, at equal distances. The last pose has the heading
    of the pose before it; a path of a single point has heading 0.
    """
    points = [path[:1]]
    for a, b in pairwise(path):
        parts = 1 if spacing is None else max(1, math.ceil(np.hypot(*(b - a)) / spacing - 1e-9))
        points.append(np.linspace(a, b, parts + 1)[1:])
    along = np.concatenate(points)
    if len(along) < 2:
        return np.column_stack([along, np.zeros(len(along))])
    dx, dy = np.diff(along, axis=0).T
    heading = np.arctan2(dy, dx)
    return np.column_stack([along, np.append(heading, heading[-1])])


def path_message(poses: NDArray[np.float64], frame: str = "map") -> dict:
    """A ``nav_msgs/Path`` as JSON data; headings become quaternions about the vertical axis."""
    header = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": frame}
    return {
        "header": header,
        "poses": [
            {
                "header": header,
                "pose": {
                    "position": {"x": x, "y": y, "z": 0.0},
                    "orientation": {"x": 0.0, "y": 0.0, "z": math.sin(yaw / 2), "w": math.cos(yaw / 2)},
                },
            }
            for x, y, yaw in poses.tolist()
        ],
    }


def write_poses(path: str | Path, poses: NDArray[np.float64]) -> None:
    """Write poses as CSV with the columns x, y (metres) and heading (radians).

    Raises
    ------
    StoreError
        The file cannot be written.
    """
    with refused_writes(path, "csv"), Path(path).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["x", "y", "heading"])
        writer.writerows([f"{value:.4f}" for value in pose] for pose in poses.tolist())
