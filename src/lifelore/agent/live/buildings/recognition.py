"""Recognises the building that a map shows, and makes the world on the building's own grid."""

from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

from lifelore.agent.building_record import (
    KIND,
    MAP_KIND,
    VERSION,
    Building,
    joined_buildings,
    map_digest,
    map_record,
    remembered_buildings,
    remembered_map,
)
from lifelore.agent.live.lore import EarlierVersion, same_place
from lifelore.agent.live.transitions import BuildingGrid, frame_key
from lifelore.core.errors import InputError
from lifelore.core.protocols import Record
from lifelore.domains.buildings.map_alignment import aligned_map
from lifelore.domains.buildings.occupancy_map import OccupancyMap
from lifelore.domains.buildings.registration import IDENTITY, Fit, Pose, Walls, composed, register, register_near
from lifelore.domains.grids.grid_world import Frame, GridWorld
from lifelore.domains.worlds import WorldSettings, world_from_settings
from lifelore.memory import Memory

LEAST_MATCH, LEAST_NAMED_MATCH = 0.96, 0.75
"""Least share of walls on walls for a recognition; the second where the user names the building. A floor with the
same walls and other furniture reaches 0.95, another building 0.6 (generated offices, see docs/courier.md)."""
LEAST_IN_FRAME = 0.85
"""The same for a map in the frame of the building whose places are mostly unchanged: other furniture leaves more,
other floors of one outline leave less."""
LEAST_MARGIN = 0.15
"""Least lead over the best clearly different pose, and over every other building."""
TIMES_MISSED, MORE_MISSED = 4.0, 15.0
"""A pose also leads if the other one misses so many times its walls, and so many metres more: rows of shelves fit
one aisle further, too, but for the outer walls. Furniture that moved since counts against both poses, if no less
ground is compared at the first."""
SAME_FRAME = 0.05, 0.002
"""Metres and radians: a pose this near to the identity is the identity."""


@dataclass(frozen=True)
class Place:
    """A world and the building in which it lies.

    world : the world to live in; positions in metres are those of the given map
    grid : the grid that its transitions share with other maps of the building
    report : the key ``building`` of the life's report; None outside buildings
        (name, recognised, agreement: share of remembered cells whose surroundings are unchanged, walls: share of
        walls that match, pose: [dx, dy, dyaw] from the map's frame to the building's, reason for a new building)
    news : records of the building that memory is to store with the first task
    occupancy : the map from which `world` was made, laid on the building's grid; None without a map
    earlier : what memory holds of the moves of this building, or of an earlier version of it
    """

    world: GridWorld
    grid: BuildingGrid
    report: dict | None = None
    news: list[Record] = field(default_factory=list)
    occupancy: OccupancyMap | None = None
    earlier: EarlierVersion | None = None


@dataclass(frozen=True)
class Recognised:
    """The building that a map shows.

    building : in memory, or made from another map
    pose : from the map's frame to that of the building's first map
    walls : share of walls that match, in [0, 1]
    """

    building: Building
    pose: Pose
    walls: float


def own_place(world: GridWorld, occupancy: OccupancyMap | None = None) -> Place:
    """A world that lies in no remembered building."""
    return Place(world, BuildingGrid(frame_key(world)), occupancy=occupancy)


def recognised_place(
    settings: WorldSettings, world: GridWorld, occupancy: OccupancyMap, memory: Memory, name: str | None = None
) -> Place:
    """The place of a building's map: in a remembered building if the map is recognised, else in a new one.

    Parameters
    ----------
    settings : WorldSettings
        Of `world`.
    world : GridWorld
        As made from `occupancy`. The place's world is another one if the map is laid on a remembered grid.
    occupancy : OccupancyMap
    memory : Memory
    name : str, optional
        Name of the building. If memory has a building of this name, the map must fit it; else the building is new.

    Raises
    ------
    InputError
        The map does not fit the building of this name, or is remembered under another name.
    """
    found, reason = recognised_building(occupancy, world, memory, name)
    laid, corner = occupancy, (0, 0)
    if found is None:
        free_name = name or _free_name(settings, occupancy, remembered_buildings(memory))
        found = Recognised(Building.new(occupancy, free_name), IDENTITY, 1.0)
    else:
        laid, corner = _laid_map(occupancy, found.pose, found.building.frame, world.frame.cell)
        if found.pose != IDENTITY or laid.origin != occupancy.origin or laid.state.shape != occupancy.state.shape:
            world = kept_world(settings, laid)
    building, recognised = found.building, reason is None
    grid = BuildingGrid(frame_key(world, Frame(world.frame.cell, building.frame.origin)), corner, building.key)
    earlier = same_place(world, memory, grid)
    report = {
        "name": building.name,
        "recognised": recognised,
        "agreement": round(earlier.agreement, 4)
        if earlier and earlier.record.about["frame"] == grid.frame
        else None,
        "walls": round(found.walls, 4) if recognised else None,
        "pose": list(found.pose) if recognised else None,
        "reason": reason,
    }
    news = []
    if memory.recall(MAP_KIND, map_digest(occupancy), VERSION) is None:
        news = [
            building.record(occupancy, found.pose, memory.recall(KIND, building.key, VERSION)),
            map_record(map_digest(occupancy), building, found.pose, found.walls),
        ]
    return Place(world, grid, report, [record for record in news if len(record.slots)], laid, earlier)


kept_world = lru_cache(maxsize=2)(world_from_settings)
_laid_map = lru_cache(maxsize=2)(aligned_map)
"""A world made of settings and a map, and a map on a building's grid; those of the last maps stay."""


def _free_name(settings: WorldSettings, occupancy: OccupancyMap, buildings: list[Building]) -> str:
    name = Path(settings.map).stem if settings.map is not None else f"office-{settings.seed}"
    taken = {building.name for building in buildings}
    return name if name not in taken else f"{name}-{map_digest(occupancy)[:6]}"


def recognised_building(
    occupancy: OccupancyMap, world: GridWorld, memory: Memory, name: str | None = None
) -> tuple[Recognised | None, str | None]:
    """The remembered building that a map shows, or None with the reason.

    Parameters and errors are those of `recognised_place`; `world` is made from `occupancy`.
    """
    buildings = remembered_buildings(memory)
    by_key = {building.key: building for building in buildings}
    seen = memory.recall(MAP_KIND, map_digest(occupancy), VERSION)
    key, pose = (seen.about["building"], tuple(seen.about["pose"])) if seen else (None, IDENTITY)
    if joined := joined_buildings(memory).get(key or ""):
        key, pose = joined.home.key, composed(joined.pose, pose)
    if seen is not None and key in by_key:
        building = by_key[key]
        if name not in (None, building.name):
            raise InputError(
                f"building of this map is remembered as {building.name!r}, got {name!r}; leave it out, or forget "
                f"that building with: lifelore memory forget --building '{building.name}'"
            )
        return Recognised(building, pose, seen.about["walls"]), None
    named = [building for building in buildings if building.name == name]
    if name is not None and not named:
        return None, "no building of this name is remembered"
    if name is None and (by_frame := _in_frame(occupancy, world, by_key, memory)):
        return by_frame, None
    return fitting_building(
        occupancy, {building: map_of(building, memory) for building in named or buildings}, name
    )


def _in_frame(
    occupancy: OccupancyMap, world: GridWorld, by_key: dict[str, Building], memory: Memory
) -> Recognised | None:
    """A map on the same grid whose percepts and walls are mostly unchanged."""
    earlier = same_place(world, memory, BuildingGrid(frame_key(world)))
    key = earlier.record.about.get("building", "") if earlier else ""
    joined = joined_buildings(memory).get(key)
    shown = joined.building if joined else by_key.get(key)
    if shown is None or shown.frame.origin != occupancy.origin:
        return None
    fit = register_near(Walls(map_of(shown, memory)), Walls(occupancy))
    if fit is None or fit.match < LEAST_IN_FRAME:
        return None
    return Recognised(joined.home, joined.pose, fit.match) if joined else Recognised(shown, IDENTITY, fit.match)


def map_of(building: Building, memory: Memory) -> OccupancyMap:
    """The map of a building as memory holds it.

    Raises
    ------
    InputError
        Another process has forgotten the building.
    """
    record = memory.recall(KIND, building.key, VERSION)
    if record is None:
        raise InputError(f"building {building.name!r} has been forgotten by another process; try again")
    return remembered_map(building, record)


def fitting_building(
    occupancy: OccupancyMap, maps: dict[Building, OccupancyMap], name: str | None = None
) -> tuple[Recognised | None, str | None]:
    """The building whose map fits, and no other building or pose nearly as well; or None with the reason.

    `name` says that the user names the building, which lowers the least match to `LEAST_NAMED_MATCH`.

    Raises
    ------
    InputError
        The map does not fit the building of this name.
    """
    if not maps:
        return None, "no building is remembered"
    new, walls = Walls(occupancy), {building: Walls(known) for building, known in maps.items()}
    in_place = ((register_near(known, new), building) for building, known in walls.items())
    fits = [(fit, of) for fit, of in in_place if fit and _near_identity(fit.pose) and fit.match >= LEAST_MATCH]
    rivals: dict[Building, Fit | None] = {}
    if not fits:
        registered = ((register(known, new), building) for building, known in walls.items())
        found = [(result, building) for result, building in registered if result]
        fits = [(result.best, building) for result, building in found]
        rivals = {building: result.second for result, building in found}
    if not fits:
        return _refused(name, "it shares too few walls with the remembered buildings")
    fits.sort(key=lambda one: -one[0].match)
    best, building = fits[0]
    if best.match < (LEAST_MATCH if name is None else LEAST_NAMED_MATCH):
        return _refused(name, f"the nearest is {building.name}, where {_percent(best.match)} of the walls match")
    second = rivals.get(building)
    if second is not None and not leads(best, second):
        return _refused(name, f"two poses fit {building.name} equally")
    if len(fits) > 1 and best.match - fits[1][0].match < LEAST_MARGIN:
        return _refused(name, f"{building.name} and {fits[1][1].name} fit equally; name the building")
    pose = IDENTITY if _near_identity(best.pose) else best.pose
    return Recognised(building, pose, best.match), None


def leads(best: Fit, second: Fit) -> bool:
    """Whether a pose fits clearly better than another one."""
    more_missed = second.missed > max(TIMES_MISSED * best.missed, best.missed + MORE_MISSED)
    # A pose under which less is compared misses less: the changed part may lie beyond the other map.
    return best.match - second.match >= LEAST_MARGIN or (more_missed and best.overlap >= second.overlap)


def _near_identity(pose: Pose) -> bool:
    return max(abs(pose[0]), abs(pose[1])) <= SAME_FRAME[0] and abs(pose[2]) <= SAME_FRAME[1]


def _refused(name: str | None, reason: str) -> tuple[None, str]:
    if name is not None:
        raise InputError(f"map does not fit building {name!r}: {reason}; give another name")
    return None, reason


def _percent(share: float) -> str:
    return f"{int(100 * share)} %"
