"""`recognise`: the building that a new map shows, the map's pose in it, and where the known places are now."""

import csv
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from math import hypot
from pathlib import Path

import numpy as np

from lifelore.agent.building_record import Building, remembered_buildings
from lifelore.agent.live.buildings.recognition import (
    LEAST_MATCH,
    LEAST_NAMED_MATCH,
    Recognised,
    fitting_building,
    recognised_building,
)
from lifelore.agent.live.goals.destinations import Destination, NamedPlaces, Point
from lifelore.agent.live.goals.job_list import named_points, read_jobs
from lifelore.core.atomic_write import refused_writes
from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.buildings.floor import Floor, floor_of
from lifelore.domains.buildings.occupancy_map import OccupancyMap, read_occupancy_map
from lifelore.domains.buildings.registration import Pose, inverse, moved
from lifelore.domains.worlds import WorldSettings, world_from_settings
from lifelore.memory import Memory, open_memory

FREE, BLOCKED, OUTSIDE = "free", "blocked", "outside"
"""States of a waypoint; ``outside`` is ground that the new map does not know."""


@dataclass(frozen=True)
class Waypoint:
    """A place of a building, found again in a new map.

    name : None for a point without a name
    before : x and y in metres of the remembered frame
    point : x and y in metres of the new map's frame
    state : ``free``, ``blocked`` or ``outside``
    reason : why the robot's centre cannot be there, in words; None where it can
    nearest : x and y of the nearest free place in the new map's frame; None where `point` is free
    """

    name: str | None
    before: Point
    point: Point
    state: str = FREE
    reason: str | None = None
    nearest: Point | None = None

    @property
    def away(self) -> float:
        """Metres from the point to the nearest free place."""
        return 0.0 if self.nearest is None else hypot(*np.subtract(self.nearest, self.point))


@dataclass(frozen=True)
class Recognition:
    """A map, recognised.

    building : name of the building
    map : the new map
    pose : (dx, dy, dyaw) in metres and radians, from the new map's frame to the remembered one
    walls : share of walls that match, in [0, 1]
    waypoints : in the order of the job list, or of their names
    """

    building: str
    map: str
    pose: Pose
    walls: float
    waypoints: tuple[Waypoint, ...]

    def to_dict(self) -> dict:
        """JSON data; points are (x, y) in metres, ``away`` is the distance to the nearest free place."""
        return {
            "building": self.building,
            "map": self.map,
            "pose": list(self.pose),
            "walls": round(self.walls, 4),
            "waypoints": [asdict(one) | {"away": one.away} for one in self.waypoints],
        }

    def write_jobs(self, path: str | Path, goals: str | Path | None = None) -> None:
        """Write the job list `goals` with its coordinates in the new map's frame, otherwise as it is.

        Without `goals`, each waypoint becomes a job.

        Raises
        ------
        StoreError
            The file cannot be written.
        """
        rows = [["name", "x", "y"], *([one.name, *_metres(one.point)] for one in self.waypoints)]
        if goals is not None:
            with Path(goals).open(newline="", encoding="utf-8-sig") as file:
                header, *jobs = [row for row in csv.reader(file) if any(field.strip() for field in row)]
            column = {name.strip().lower(): at for at, name in enumerate(header)}
            rows = [header, *(self._in_new_frame(row, column) for row in jobs)]
        with refused_writes(path, "out"), Path(path).open("w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)

    def _in_new_frame(self, row: list[str], column: dict[str, int]) -> list[str]:
        if "x" not in column or not row[column["x"]].strip():
            return row
        (point,) = _moved(inverse(self.pose), [(float(row[column["x"]]), float(row[column["y"]]))])
        moved_row = list(row)
        moved_row[column["x"]], moved_row[column["y"]] = _metres(point)
        return moved_row


def recognise(
    map: str | Path,
    memory: str | Path | None = None,
    goals: str | Path | None = None,
    *,
    old: str | Path | None = None,
    building: str | None = None,
    cell: float | None = None,
    robot_radius: float | None = None,
) -> Recognition:
    """Recognise the building that a map shows, and find its known places in the frame of this map.

    Memory is only read.

    Parameters
    ----------
    map : str or Path
        YAML of the new ROS map.
    memory : str or Path, optional
        SQLite file or URL; None: the user's own.
    goals : str or Path, optional
        Job list (``lifelore live --goals``) in metres of the remembered frame, which is that of the building's
        first map, or of `old`. None: all places of the building that memory knows by name.
    old : str or Path, optional
        YAML of an earlier map of the building, to compare with in place of memory.
    building : str, optional
        Name of the building: compare with this one alone, and accept a map of which 75 % of the walls match.
    cell, robot_radius : float, optional
        Metres, as in ``lifelore live``; they decide which places are free.

    Raises
    ------
    NotFoundError
        Memory has no building, or not this one, or not a name of the job list.
    InputError
        The map shows no remembered building, or one of which this is not certain; or a file or setting breaks its
        rule.
    StoreError
        Memory cannot be read.

    Examples
    --------
    >>> found = recognise("new.yaml", memory="robot.db", goals="jobs.csv")  # doctest: +SKIP
    >>> [(place.name, place.point, place.state) for place in found.waypoints]  # doctest: +SKIP
    [('dock', (12.3, -2.7), 'free'), ('gate', (40.1, 3.2), 'blocked')]
    """
    if old is not None and memory is not None:
        raise InputError("old and memory exclude each other; give the map or the memory to compare with")
    occupancy = read_occupancy_map(map)
    world = world_from_settings(WorldSettings("building", map, cell=cell, robot_radius=robot_radius), occupancy)
    if old is not None:
        earlier = read_occupancy_map(old)
        maps = {Building.new(earlier, building or Path(old).stem): earlier}
        found = _recognised(occupancy, lambda one, name: fitting_building(one, maps, name), building)
        places = [] if goals is None else _places_of(goals, _without_memory)
    else:
        with open_memory(memory, read_only=True) as opened:
            _check_known(opened, building)
            found = _recognised(
                occupancy, lambda one, name: recognised_building(one, world, opened, name), building
            )
            names = NamedPlaces(found.building.key)
            known = [Destination(name=name) for name in names.names(opened)]
            places = [names.located("goals", one, opened) for one in known]
            if goals is not None:
                places = _places_of(goals, lambda one: names.located("goals", one, opened))
    waypoints = _found_again(places, inverse(found.pose), floor_of(occupancy, world))
    return Recognition(found.building.name, str(map), found.pose, found.walls, waypoints)


def _check_known(memory: Memory, building: str | None) -> None:
    names = [one.name for one in remembered_buildings(memory)]
    if not names:
        raise NotFoundError(
            "memory knows no building; live or learn from runs on the earlier map first (lifelore live, lifelore "
            "learn-from), or give that map (--old)"
        )
    if building is not None and building not in names:
        raise NotFoundError(f"memory knows no building '{building}'; it knows {', '.join(names)}")


def _recognised(
    occupancy: OccupancyMap,
    compare: Callable[[OccupancyMap, str | None], tuple[Recognised | None, str | None]],
    name: str | None,
) -> Recognised:
    """The building that a map certainly shows; its mirror image is refused."""
    found, reason = compare(occupancy, name)
    if found is not None and found.walls >= LEAST_MATCH:
        return found
    mirrored, _ = compare(replace(occupancy, state=occupancy.state[:, ::-1]), None)
    if mirrored is not None:
        raise InputError(
            f"map {occupancy.source} shows a mirror image of {mirrored.building.name}; flip the image, or correct "
            "the direction of an axis"
        )
    if found is not None:
        return found
    advice = "give a map that shows more of the building"
    if name is None:
        advice += f", or name it (--building): then {100 * LEAST_NAMED_MATCH:.0f} % of the walls suffice"
    raise InputError(f"map {occupancy.source} is not recognised: {reason}; {advice}")


def _places_of(goals: str | Path, locate: Callable[[Destination], Destination]) -> list[Destination]:
    """The places of a job list, each once, in the order of the file."""
    jobs = read_jobs(goals)
    points = named_points(jobs)
    ends = [job.destination for job in sorted(jobs, key=lambda job: job.line)]
    located = [replace(end, point=points[end.name]) if end.name in points else locate(end) for end in ends]
    return list(dict.fromkeys(located))


def _without_memory(place: Destination) -> Destination:
    if place.point is None:
        raise NotFoundError(f"goals: no line gives the position of '{place.name}'; write its x and y once")
    return place


def _found_again(places: Sequence[Destination], pose: Pose, floor: Floor) -> tuple[Waypoint, ...]:
    """Places of the remembered frame at a pose in the frame of the new map."""
    found = []
    for place, point in zip(places, _moved(pose, [place.located_point for place in places]), strict=True):
        one, refusal = Waypoint(place.name, place.located_point, point), floor.refusal(point)
        if refusal is not None:
            state = BLOCKED if refusal.known else OUTSIDE
            one = replace(one, state=state, reason=refusal.reason, nearest=refusal.nearest)
        found.append(one)
    return tuple(found)


def _moved(pose: Pose, points: Sequence[Point]) -> list[Point]:
    return [(x, y) for x, y in moved(pose, np.reshape(points, (-1, 2))).round(6).tolist()]


def _metres(point: Point) -> list[str]:
    return [f"{value:.3f}" for value in point]
