"""What memory knows of a building, as nav2 reads it: masks, and a graph of the ways between its places."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.live.buildings.recognition import Place, recognised_place
from lifelore.agent.live.goals.destinations import NamedPlaces, Point
from lifelore.agent.live.lore import Lore
from lifelore.agent.live.output.folder import folder_to_write
from lifelore.agent.live.output.nav2_masks import write_masks
from lifelore.agent.travel.move_costs import MoveCosts
from lifelore.agent.travel.travel import Travel
from lifelore.core.errors import NotFoundError
from lifelore.core.learning.known_world import WorldModel
from lifelore.domains.buildings.floor import Floor, floor_of
from lifelore.domains.buildings.occupancy_map import OccupancyMap
from lifelore.domains.worlds import WorldSettings, map_from_settings, world_from_settings
from lifelore.memory import Memory, open_memory

MASK_FILES = ("costs.pgm", "costs.yaml", "speed.pgm", "speed.yaml", "keepout.pgm", "keepout.yaml")
ROUTE_FILE = "route_graph.geojson"
NAV2_FILES = (*MASK_FILES, ROUTE_FILE)


@dataclass(frozen=True, eq=False)
class KnownBuilding:
    """A building, the places that a robot knows there, and what driving costs.

    occupancy : the map of the building, laid on the grid of its first map
    given : the user's map
    known : (n_states,) whether the robot has visited a place
    travel : what was observed of its moves
    places : points in metres by name
    """

    occupancy: OccupancyMap
    given: OccupancyMap
    known: NDArray[np.bool_]
    travel: Travel
    places: Mapping[str, Point]

    @classmethod
    def recalled(cls, place: Place, given: OccupancyMap, memory: Memory, model: WorldModel | None = None) -> Self:
        """What memory knows; `model` in place of the remembered moves, for an agent that does not share them."""
        travel = Travel.recalled(place.world, place.grid, memory)
        if model is None:
            known = Lore.recalled(place.world, 1.0, memory, place.grid).model.percept >= 0
            known |= travel.driven
        else:
            known = model.percept >= 0
        places = NamedPlaces.of(place).points(memory)
        return cls(place.occupancy or given, given, known, travel, places)

    @cached_property
    def floor(self) -> Floor:
        """The building at the resolution of its map."""
        return floor_of(self.occupancy, self.travel.world)

    @cached_property
    def costs(self) -> MoveCosts:
        """The costs of its moves at the newest observation."""
        return self.travel.costs(self.travel.newest)

    def write(self, folder: Path, more_places: Mapping[str, Point] | None = None) -> list[str]:
        """Write `NAV2_FILES` into a folder; the names of those that were written.

        Nothing is written of a building that the robot does not know, and no graph without two places that a known
        way joins. `more_places` are used after those that memory knows by name.

        Raises
        ------
        OSError, StoreError
            The files cannot be written.
        """
        from lifelore.agent.live.output.route_graph import write_route_graph

        if not self.known.any():
            return []
        write_masks(folder, self.costs, self.known, self.floor, self.given)
        places = {**self.places, **(more_places or {})}
        written = write_route_graph(folder / ROUTE_FILE, self.costs, self.known, self.floor, places)
        if not written:
            (folder / ROUTE_FILE).unlink(missing_ok=True)
        return [*MASK_FILES, ROUTE_FILE] if written else list(MASK_FILES)


def write_known_building(
    out: str | Path, settings: WorldSettings, memory: str | Path | None = None, building: str | None = None
) -> list[str]:
    """Write what memory knows of a building for nav2; the names of the files in the folder `out`.

    Raises
    ------
    NotFoundError
        Memory knows no place of this building.
    InputError
        A setting or the map breaks its rule, or `out` is no folder.
    StoreError
        Memory cannot be read, or the files cannot be written.
    """
    given = map_from_settings(settings)
    with open_memory(memory, read_only=True) as opened:
        place = recognised_place(settings, world_from_settings(settings, given), given, opened, building)
        known = KnownBuilding.recalled(place, given, opened)
    if not known.known.any():
        raise NotFoundError(
            f"memory knows no place of the map {settings.map} with this cell and robot radius; live there first "
            "(lifelore live --map, lifelore learn-from), or give the options with which the robot lived there"
        )
    with folder_to_write(out) as folder:
        return known.write(folder)
