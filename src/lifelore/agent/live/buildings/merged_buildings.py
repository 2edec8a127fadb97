"""Merges memories, and joins the buildings of one to those of another that show the same place.

A building is joined if its map fits another one as a new map of that building would (`fitting_building`). Its map
extends the other one. Its names, passes and found goals stay as they are stored, and are read through the pose.
"""

from collections.abc import Sequence
from math import dist
from pathlib import Path
from typing import Any

from lifelore.agent.building_record import (
    KIND,
    MAP_KIND,
    VERSION,
    Building,
    joined_buildings,
    map_record,
    remembered_buildings,
)
from lifelore.agent.live.buildings.recognition import Recognised, fitting_building, map_of
from lifelore.agent.live.goals.destinations import NamedPlaces
from lifelore.core.errors import StoreError
from lifelore.domains.buildings.registration import inverse
from lifelore.memory import Memory, open_memory

ROBOT = "merge"
"""The robot that contributes what joins buildings; forgetting it takes them apart."""
SAME_NAME = 0.5
"""Metres: places of one name that are farther apart are two places."""


def merge_memories(memory: Memory, others: Sequence[str | Path]) -> tuple[list[dict[str, int]], list[dict]]:
    """Merge memories and exported files into a memory, and join the buildings that come in.

    Returns
    -------
    counts : list of dict
        For each of `others`, as of `Memory.merge_from`.
    buildings : list of dict
        For each building that comes in, and each of the memory's own that one of `others` had joined to another:
        its name ``building``; ``joined``, the name of the building to which it was joined, or None; ``reason`` for
        that, None if it is the first building; ``walls``, the share of walls that match, and ``pose``
        [dx, dy, dyaw] from its frame to that of the other, None where it was not joined;
        ``names`` of places that the two know at different points.

    Raises
    ------
    StoreError
        As of `Memory.merge_many`; or robots of one name met different types apart. Nothing is merged.
    """
    own, incoming = [one.key for one in remembered_buildings(memory)], []
    with memory.together():
        before = _mixed_types(memory)
        counts = memory.merge_many(others)
        if (mixed := _mixed_types(memory) - before) and (mixed := mixed - _mixed_before(others)):
            key, name = min(mixed, key=str)
            raise StoreError(
                f"two robots of one name each met a type '{name}' of '{key}', which would become one type; "
                "nothing was merged. Robots that live apart need names of their own (--robot NAME, robot=NAME)"
            )
    for other in others:
        with open_memory(other, read_only=True) as opened:
            incoming += [one.key for one in remembered_buildings(opened)]
    order = {key: number for number, key in reversed(list(enumerate(own + incoming)))}
    found = sorted(remembered_buildings(memory), key=lambda one: order.get(one.key, -1))
    maps, report = {one: map_of(one, memory) for one in found if one.key in own}, []
    for key, joined in joined_buildings(memory).items():
        if key in own and (record := memory.recall(MAP_KIND, key, VERSION)):
            to = Recognised(joined.home, joined.pose, record.about["walls"])
            report.append(_entry(joined.building, to, None, memory))
    for one in found:
        if one not in maps:
            occupancy = map_of(one, memory)
            to, reason = fitting_building(occupancy, maps) if maps else (None, None)
            if to and not _join(one, to, memory):
                to, reason = None, f"the robot {ROBOT}, which joined them before, was forgotten"
            report.append(_entry(one, to, reason, memory))
            if to is None:
                maps[one] = occupancy
    return counts, report


def _mixed_types(memory: Memory) -> set[tuple[Any, Any]]:
    """(key, name) of each type that two tasks with different descriptions showed first."""
    first: dict[tuple[Any, Any], dict[str, Any]] = {}
    mixed: set[tuple[Any, Any]] = set()
    for robot in memory.robots():
        for task in memory.task_descriptions(robot):
            if task.get("new_type") or (task.get("new") and "type" in task):
                name = (task.get("key", task.get("domain")), task.get("type", task.get("learnt")))
                if first.setdefault(name, task) != task:
                    mixed.add(name)
    return mixed


def _mixed_before(others: Sequence[str | Path]) -> set[tuple[Any, Any]]:
    """Types that one of several memories has mixed already, as earlier versions did."""
    mixed: set[tuple[Any, Any]] = set()
    for other in others:
        with open_memory(other, read_only=True) as opened:
            mixed |= _mixed_types(opened)
    return mixed


def _join(one: Building, to: Recognised, memory: Memory) -> bool:
    map_of_home = memory.recall(KIND, to.building.key, VERSION)
    records = [
        map_record(one.key, to.building, to.pose, to.walls),
        to.building.record(map_of(one, memory), to.pose, map_of_home),
    ]
    task = {"building": one.name, "joined": to.building.name}
    records = [record for record in records if len(record.slots)]
    return memory.contribute(ROBOT, records, process=f"join {one.key}", seq=0, task=task)


def _entry(one: Building, to: Recognised | None, reason: str | None, memory: Memory) -> dict[str, Any]:
    if to is None:
        return {"building": one.name, "joined": None, "reason": reason, "walls": None, "pose": None, "names": []}
    ours = NamedPlaces(to.building.key).points(memory)
    theirs = NamedPlaces(one.key, inverse(to.pose)).points(memory)
    apart = [name for name in theirs if dist(ours[name], theirs[name]) > SAME_NAME]
    found = {"walls": round(to.walls, 4), "pose": list(to.pose), "names": apart}
    return {"building": one.name, "joined": to.building.name, "reason": None, **found}


def described(entry: dict[str, Any]) -> str:
    """An entry of ``buildings`` as a line for people."""
    line = f"building {entry['building']}: "
    if entry["reason"] is None and entry["joined"] is None:
        return line + "is new here"
    if entry["joined"] is None:
        return line + f"stays a building of its own: {entry['reason']}"
    line += f"joined to {entry['joined']}, {int(100 * entry['walls'])} % of the walls agree"
    if entry["names"]:
        line += (
            f"; both know {', '.join(entry['names'])} at different points: those of {entry['joined']} count, "
            "move them with `lifelore live --goals` and --set move_names=true"
        )
    return line
