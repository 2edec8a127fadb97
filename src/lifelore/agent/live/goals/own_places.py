"""The start and the goals that the user chose for a life, as states of its world."""

import math
from dataclasses import dataclass

from lifelore.agent.live.buildings.recognition import Place
from lifelore.agent.live.goals.destinations import Destination, NamedPlaces
from lifelore.agent.live.goals.job_list import for_each, named_points
from lifelore.agent.live.life_settings import LifeSettings
from lifelore.agent.live.life_settings import Place as Chosen
from lifelore.core.errors import InputError
from lifelore.core.protocols import Record
from lifelore.domains.buildings.floor import floor_of
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.memory import Memory


@dataclass(frozen=True)
class OwnGoal:
    """A goal that the user chose.

    state : in the world of the life
    destination : its point and name; None in worlds without metres
    time : as in the job list
    names : records by which memory knows the destination by its name from then on
    """

    state: int
    destination: Destination | None = None
    time: str | None = None
    names: tuple[Record, ...] = ()

    def to_dict(self) -> dict:
        """JSON data: ``position`` in metres, ``name`` and ``time``, each where there is one."""
        end = self.destination
        data = {"position": end and end.point and list(end.point), "name": end and end.name, "time": self.time}
        return {key: value for key, value in data.items() if value is not None}


@dataclass(frozen=True)
class OwnPlaces:
    """Start and goals of a life.

    start : state in which every episode starts; None: any
    goals : a goal for each task of this life, or one goal for all; empty: goals are drawn
    """

    start: int | None = None
    goals: tuple[OwnGoal, ...] = ()

    def goal(self, seq: int) -> OwnGoal | None:
        """The goal of task number `seq` of this life; None if it is drawn."""
        if not self.goals:
            return None
        return self.goals[0] if len(self.goals) == 1 else self.goals[seq]


def own_places(settings: LifeSettings, place: Place, memory: Memory) -> OwnPlaces:
    """The places that the settings name.

    Raises
    ------
    InputError
        A place is not free, start and goal are the same place, or memory knows a name elsewhere; the message names
        the argument, and up to ten lines of a job list.
    NotFoundError
        Memory does not know a name.
    """
    world = place.world
    if settings.world.domain != "building":
        start = None if settings.start is None else grid_state("start", settings.start, world)
        goals = () if settings.goal is None else (OwnGoal(grid_state("goal", settings.goal, world)),)
        return _checked(OwnPlaces(start, goals))
    asked = [("goal", Destination.of(settings.goal), None)] if settings.goal is not None else []
    asked += [(f"goals line {job.line}", job.destination, job.time) for job in settings.goals]
    if settings.start is None and not asked:
        return OwnPlaces()
    names, named = NamedPlaces.of(place), named_points(settings.goals)
    assert place.occupancy is not None, "a building has a map"
    floor = floor_of(place.occupancy, world)
    farthest = math.inf if settings.move_names else world.frame.cell

    def located(argument: str, end: Destination, time: str | None = None) -> OwnGoal:
        if end.point is None and end.name in named:
            end = Destination(named[end.name], end.name)
        end = names.located(argument, end, memory)
        _check_unmoved(argument, end, names, memory, farthest)
        records = () if end.name is None else (names.record(end.name, end.located_point),)
        return OwnGoal(floor.state_at(argument, end.located_point), end, time, records)

    start = None if settings.start is None else located("start", Destination.of(settings.start)).state
    places = OwnPlaces(start, tuple(for_each(lambda one: located(*one), asked)))
    return places if settings.goals else _checked(places)


def _check_unmoved(argument: str, end: Destination, names: NamedPlaces, memory: Memory, farthest: float) -> None:
    """Refuse a point for a name that memory knows at a place farther away than `farthest` metres."""
    known = None if end.name is None else names.remembered(end.name, memory)
    if known is not None and (away := math.dist(known, end.located_point)) > farthest:
        (x, y), (new_x, new_y) = known, end.located_point
        raise InputError(
            f"{argument}: memory knows '{end.name}' at {x:g},{y:g}, {away:.2f} m from {new_x:g},{new_y:g}; leave "
            "the point out to go there, or move the name with --set move_names=true"
        )


def grid_state(argument: str, place: Chosen, world: GridWorld) -> int:
    """The state in the cell (row, column) of a world without metres.

    Raises
    ------
    InputError
        The cell is not free; the message names the nearest free cell.
    """
    if isinstance(place, str):
        raise InputError(f"{argument} must be ROW,COL in domain '{world.name}', got '{place}'")
    row, column = place
    rows, columns = world.shape
    whole = int(row) == row and int(column) == column
    if whole and 0 <= row < rows and 0 <= column < columns and world.state_of[int(row), int(column)] >= 0:
        return int(world.state_of[int(row), int(column)])
    near = world.cells[((world.cells - (float(row), float(column))) ** 2).sum(axis=1).argmin()]
    raise InputError(
        f"{argument} must be a free cell ROW,COL of this world ({rows} rows, {columns} columns), "
        f"got {row},{column}; the nearest free cell is {near[0]},{near[1]}"
    )


def _checked(places: OwnPlaces) -> OwnPlaces:
    if any(goal.state == places.start for goal in places.goals):
        raise InputError("goal must lie in another cell than start, got the same cell; move one of them")
    return places
