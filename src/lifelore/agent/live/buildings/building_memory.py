"""Lists the remembered buildings, and forgets one."""

from lifelore.agent import building_record
from lifelore.agent.building_record import joined_buildings, remembered_buildings
from lifelore.agent.live import transitions
from lifelore.agent.live.driven import robot_clock
from lifelore.agent.live.goals import destinations, goal_counts
from lifelore.agent.travel import passes
from lifelore.core.errors import InputError, NotFoundError
from lifelore.memory import Memory

_OF_A_BUILDING = (
    building_record.MAP_KIND,
    transitions.KIND,
    destinations.KIND,
    goal_counts.KIND,
    passes.KIND,
    robot_clock.KIND,
)
"""Kinds of records that are forgotten with their building."""


def buildings_in(memory: Memory) -> list[dict]:
    """One entry a building, by name: ``name``, ``key``, ``maps`` (files seen), ``grids`` (with transitions)."""
    home = {key: joined.home.key for key, joined in joined_buildings(memory).items()}
    maps, grids = (
        [home.get(key := about.get("building", ""), key) for _, _, about in memory.keys(kind)]
        for kind in (building_record.MAP_KIND, transitions.KIND)
    )
    return [
        {"name": one.name, "key": one.key, "maps": maps.count(one.key), "grids": grids.count(one.key)}
        for one in remembered_buildings(memory)
    ]


def forget_building(memory: Memory, name: str) -> dict:
    """Forget a building's map, transitions, named destinations, found goals and passes; other records stay.

    Returns
    -------
    dict
        ``building``, its name; ``records``, the number of forgotten records; ``contributions`` that lost any.

    Raises
    ------
    NotFoundError
        Memory has no building of this name.
    InputError
        Several buildings, merged from different memories, have this name.
    """
    buildings = remembered_buildings(memory)
    keys = [one.key for one in buildings if name in (one.name, one.key)]
    if not keys:
        known = ", ".join(sorted({one.name for one in buildings})) or "none"
        raise NotFoundError(f"building {name!r} is not remembered here; known buildings: {known}")
    if len(keys) > 1:
        raise InputError(f"building {name!r} is the name of {len(keys)} buildings; give a key: {', '.join(keys)}")
    keys += [key for key, joined in joined_buildings(memory).items() if joined.home.key == keys[0]]
    names = [(building_record.KIND, key, building_record.VERSION) for key in keys]
    for kind in _OF_A_BUILDING:
        names += [
            (kind, key, version) for key, version, about in memory.keys(kind) if about.get("building") in keys
        ]
    return {"building": name, "records": len(names), "contributions": memory.forget_records(names)}
