"""Lists the remembered buildings, and forgets one."""

from lifelore.agent.live import transitions
from lifelore.agent.live.buildings import building_record
from lifelore.agent.live.buildings.building_record import remembered_buildings
from lifelore.agent.live.goals import destinations, goal_counts
from lifelore.agent.travel import passes
from lifelore.core.errors import InputError, NotFoundError
from lifelore.memory import Memory


def buildings_in(memory: Memory) -> list[dict]:
    """One entry a building, by name: ``name``, ``key``, ``maps`` (files seen), ``grids`` (with transitions)."""
    maps = [about["building"] for _, _, about in memory.keys(building_record.MAP_KIND)]
    grids = [about.get("building") for _, _, about in memory.keys(transitions.KIND)]
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
    names = [(building_record.KIND, keys[0], building_record.VERSION)]
    for kind in (building_record.MAP_KIND, transitions.KIND, destinations.KIND, goal_counts.KIND, passes.KIND):
        names += [
            (kind, key, version) for key, version, about in memory.keys(kind) if about.get("building") == keys[0]
        ]
    return {"building": name, "records": len(names), "contributions": memory.forget_records(names)}
