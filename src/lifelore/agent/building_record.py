"""Converts a remembered building to records of memory and back: one of its map, one for each map file seen.

The record of the map has a slot for each run of 30 pixels on the grid of the building's first map, with two bits a
pixel. The newest map counts, run by run, so that the memory follows a building that changes. The record of a map
file has the file's digest as key, and the pose of the file on the building, so that no map is compared twice.

A building's key is the digest of its first map. If the record of that map names another building, the two were
joined: they are one building in the frame of the other. What was learnt in the old frame is read through the pose.
"""

import hashlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.protocols import Record
from lifelore.domains.buildings.map_alignment import MapFrame, aligned_map
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, UNKNOWN, OccupancyMap
from lifelore.domains.buildings.registration import IDENTITY, Pose, composed, inverse, moved
from lifelore.domains.grids.cell_numbers import COLUMN_BITS, BuildingGrid, states_in
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.memory import Memory

KIND, MAP_KIND, VERSION = "building", "building_map", 1
FINEST, MOST_PIXELS = 0.05, 4_000_000
"""Smallest side of a stored pixel in metres, and largest number of pixels; larger maps are stored coarser."""
_RUN = 30  # pixels a slot: two bits each in 60 of 63
_LOW_BITS = np.int64((4**_RUN - 1) // 3)  # the lower bit of each pixel
_ZERO = 1 << 19  # row and run of the first map's lower left corner, so that slots stay positive
_CODE = np.zeros(3, np.int64)
_CODE[[UNKNOWN, FREE, OCCUPIED]] = 0, 1, 2
_STATE = np.array([UNKNOWN, FREE, OCCUPIED, UNKNOWN], np.uint8)


@dataclass(frozen=True)
class Building:
    """A building in memory.

    key : identity in memory: the digest of its first map
    name : for people
    frame : frame of its first map
    pixel : side of a stored pixel in metres
    """

    key: str
    name: str
    frame: MapFrame
    pixel: float

    @classmethod
    def new(cls, occupancy: OccupancyMap, name: str) -> "Building":
        """The building whose first map this is."""
        pixel = max(occupancy.resolution, FINEST)
        while occupancy.state.size * (occupancy.resolution / pixel) ** 2 > MOST_PIXELS:
            pixel *= 2
        return cls(map_digest(occupancy), name, MapFrame.of(occupancy), pixel)

    def record(self, occupancy: OccupancyMap, pose: Pose, before: Record | None) -> Record:
        """The runs of a map that differ from those `before`; the pose is as in `aligned_map`."""
        laid, corner = aligned_map(occupancy, pose, self.frame, self.pixel * _RUN, self.pixel)
        columns = -(-laid.state.shape[1] // _RUN) * _RUN
        code = np.zeros((laid.state.shape[0], columns), np.int64)
        code[:, : laid.state.shape[1]] = _CODE[laid.state[::-1]]
        runs = (code.reshape(len(code), -1, _RUN) << (2 * np.arange(_RUN))).sum(axis=-1)
        row = np.arange(len(runs))[:, None] + corner[0] * _RUN + _ZERO
        slots = ((row << 20) + np.arange(runs.shape[1]) + corner[1] + _ZERO).ravel()
        values, earlier = runs.ravel(), np.zeros(runs.size, np.int64)
        if before is not None and before.slots.size:
            at = np.minimum(np.searchsorted(before.slots, slots), before.slots.size - 1)
            earlier = np.where(before.slots[at] == slots, before.values[at], 0)
        # Ground that the new map does not know stays as it was.
        values = values | (earlier & ~(((values | (values >> 1)) & _LOW_BITS) * 3))
        news = values != earlier
        about = {
            "name": self.name,
            "origin": list(self.frame.origin),
            "size": list(self.frame.size),
            "pixel": self.pixel,
        }
        return Record(KIND, self.key, VERSION, "newest", slots[news], values[news], about)


@dataclass(frozen=True)
class Joined:
    """A building that was joined to another one.

    building : as it was before
    home : the building of which it is a part
    pose : from the frame of `building` to that of `home`
    """

    building: Building
    home: Building
    pose: Pose

    @property
    def motion(self) -> Pose:
        """From the lower left corner of the first map of `building` to that of `home`."""
        return composed(inverse(self.home.frame.origin), composed(self.pose, self.building.frame.origin))

    def states(
        self, world: GridWorld, grid: BuildingGrid, row: NDArray[np.int64], column: NDArray[np.int64]
    ) -> NDArray[np.int64]:
        """The states (n,) of a world of `home` at the middles of cells of `building`; -1 where there is none."""
        side, centres = world.frame.cell, np.column_stack([column, row]) + 0.5
        x, y = np.floor(moved(self.motion, centres * side) / side).astype(np.int64).T
        x, y = x - grid.corner[1], y - grid.corner[0]
        return states_in(world, np.where((x >= 0) & (y >= 0), (y << COLUMN_BITS) | x, -1))


def remembered_buildings(memory: Memory) -> list[Building]:
    """All buildings in memory that are not joined to another, by name and key."""
    joined = joined_buildings(memory)
    found = [building for key, building in _all_buildings(memory).items() if key not in joined]
    return sorted(found, key=lambda building: (building.name, building.key))


def joined_buildings(memory: Memory) -> dict[str, Joined]:
    """The buildings that were joined to another one, by key."""
    every = _all_buildings(memory)
    maps = ((key, about) for key, version, about in memory.keys(MAP_KIND) if version == VERSION)
    link = {key: about for key, about in maps if key in every and about["building"] in every.keys() - {key}}
    for key in sorted(link):
        # Two memories may have joined the same buildings in opposite directions: the smallest key of a ring stays.
        ring = [key]
        while ring[-1] in link and (following := link[ring[-1]]["building"]) not in ring:
            ring.append(following)
        if ring[-1] in link and link[ring[-1]]["building"] == key:
            del link[key]
    return {key: _joined(every[key], link, every) for key in link}


def _joined(building: Building, link: dict[str, dict], every: dict[str, Building]) -> Joined:
    key, pose = building.key, IDENTITY
    while key in link:
        key, pose = link[key]["building"], composed(tuple(link[key]["pose"]), pose)
    return Joined(building, every[key], pose)


def _all_buildings(memory: Memory) -> dict[str, Building]:
    return {key: _building(key, about) for key, version, about in memory.keys(KIND) if version == VERSION}


def _building(key: str, about: dict) -> Building:
    frame = MapFrame(tuple(about["origin"]), tuple(about["size"]))
    return Building(key, about["name"], frame, about["pixel"])


def remembered_map(building: Building, record: Record) -> OccupancyMap:
    """The stored map, in the world frame of the building's first map."""
    row, run = (record.slots >> 20) - _ZERO, (record.slots & (2**20 - 1)) - _ZERO
    low = int(row.min()), int(run.min())
    shape = int(row.max()) - low[0] + 1, (int(run.max()) - low[1] + 1) * _RUN
    state = np.full(shape, UNKNOWN, np.uint8)
    codes = (record.values[:, None] >> (2 * np.arange(_RUN))) & 3
    columns = (run - low[1])[:, None] * _RUN + np.arange(_RUN)
    state[(row - low[0])[:, None], columns] = _STATE[codes]
    corner = (low[1] * _RUN * building.pixel, low[0] * building.pixel, 0.0)
    origin = composed(building.frame.origin, corner) if any(corner) else building.frame.origin
    return OccupancyMap(np.ascontiguousarray(state[::-1]), building.pixel, origin, building.name)


def map_digest(occupancy: OccupancyMap) -> str:
    """Hash of a map's pixels, resolution and origin: equal only for the same map."""
    digest = hashlib.sha256(np.ascontiguousarray(occupancy.state).tobytes())
    digest.update(repr((occupancy.state.shape, occupancy.resolution, occupancy.origin)).encode())
    return digest.hexdigest()[:32]


def map_record(digest: str, building: Building, pose: Pose = IDENTITY, walls: float = 1.0) -> Record:
    """That the map of this digest shows this building at this pose; `walls` is the share of walls that match."""
    about = {"building": building.key, "pose": list(pose), "walls": round(walls, 4)}
    return Record(MAP_KIND, digest, VERSION, "newest", np.zeros(1, np.int64), np.ones(1, np.int64), about)
