"""A building for people to walk in: its named places, the sight from each state, and experts who know the ways."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from lifelore.agent.advise.advise import AdviseSettings, world_settings
from lifelore.agent.live.buildings.recognition import recognised_place
from lifelore.agent.live.goals.destinations import NamedPlaces
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.learning.known_world import GOAL, goal_distances
from lifelore.core.streams import stream
from lifelore.domains.buildings.floor import Floor, floor_of, floor_of_cells
from lifelore.domains.buildings.visibility import visible_places
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.worlds import WorldSettings, map_from_settings, world_from_settings
from lifelore.memory import Memory

PLACE_NAMES = ("kitchen", "printer", "library", "workshop", "post room", "studio", "archive", "reception")
"""Names of the places of generated worlds. Those of a served map have the user's names, or numbers."""
MOST_NAMES = 20
"""Largest number of the user's places in a building, the first by name; more take longer to prepare."""
REACH = 6.0
"""Metres that a person sees; in a maze, cells. Larger makes the search easier."""
WALKS = 30
"""Number of experts' walks to each place; more give advice in more states."""
MOST_STATES = 20_000
"""Maximum number of states; the tables of the advisor take 3 kB each."""
GENERATED = (
    ("building:0", "Generated office A"),
    ("building:1", "Generated office B"),
    ("building:2", "Generated office C"),
    ("advice:3", "Maze of the thesis's experiment (§3.7)"),
)
"""Worlds that need no map, and their titles."""


@dataclass(frozen=True, eq=False)
class WalkBuilding:
    """A building for people to walk in; made by `walk_building`.

    name : str, the map's name or NAME:SEED
    world : GridWorld
    names : (n_places,) names of the places that people look for
    places : (n_places,) int64, their states
    distance : (n_places, n_states) int32, moves to each place
    sight : (n_states, n_states) bool, sparse, whether a state is in sight of another
    """

    name: str
    world: GridWorld
    names: tuple[str, ...]
    places: NDArray[np.int64]
    distance: NDArray[np.int32]
    sight: sparse.csr_array

    def in_sight(self, state: int) -> NDArray[np.integer]:
        """The states in sight of a state, ascending."""
        return self.sight.indices[self.sight.indptr[state] : self.sight.indptr[state + 1]]

    def errand(self, walk: str) -> tuple[int, int]:
        """Start and place (its number) of a walk; the same name gives the same errand.

        The start is out of sight of the place, and an expert has passed it: elsewhere nobody could advise the
        person. It is one of the farther half of these states.
        """
        random = stream(0, "walk errand", self.name, walk)
        place = int(random.integers(len(self.places)))
        passed = self._passed & (self.distance[place] > 0)
        hidden = passed.copy()
        hidden[self.in_sight(int(self.places[place]))] = False
        starts = np.flatnonzero(hidden if hidden.any() else passed)
        far = self.distance[place, starts]
        return int(random.choice(starts[far >= np.median(far)])), place

    @cached_property
    def _passed(self) -> NDArray[np.bool_]:
        """(n_states,) states in which an expert has moved."""
        passed = np.zeros(self.world.n_states, np.bool_)
        passed[[step["state"] for step in self.expert_steps if step["action"] is not None]] = True
        return passed

    @cached_property
    def expert_steps(self) -> list[dict[str, Any]]:
        """Steps of simulated experts, who walk a shortest way to each place from `WALKS` random states."""
        random, steps = stream(0, "walk experts", self.name), []
        for place, distance in enumerate(self.distance):
            for number, start in enumerate(random.choice(np.flatnonzero(distance > 0), WALKS)):
                agent, state = f"{place}/{number}", int(start)
                while distance[state] > 0:
                    move = int(random.choice(self._nearer(place, state)))
                    steps.append({"agent": agent, "state": state, "action": move})
                    state = int(self.world.neighbour[state, move])
                steps.append({"agent": agent, "state": state, "action": None})
        return steps

    def _nearer(self, place: int, state: int) -> NDArray[np.int64]:
        target, distance = self.world.neighbour[state], self.distance[place]
        return np.flatnonzero((target >= 0) & (distance[target] == distance[state] - 1))


def walk_buildings(maps: Mapping[str, str]) -> list[dict[str, str]]:
    """The buildings that a person can walk in, served maps first: {"name", "title"}."""
    served = [{"name": name, "title": f"{name} (your map)"} for name in sorted(maps)]
    return served + [{"name": name, "title": title} for name, title in GENERATED]


def walk_building(name: str, maps: Mapping[str, str], memory: Memory | None = None) -> WalkBuilding:
    """One of the `walk_buildings`.

    People look for the destinations that memory knows by name in a served map; without any, for places far from
    each other.

    Raises
    ------
    NotFoundError
        No building has this name.
    InputError, StoreError
        The map breaks a rule or cannot be read, or the building is too large.
    """
    known = [found["name"] for found in walk_buildings(maps)]
    if name not in known:
        raise NotFoundError(f"building must be one of {', '.join(known)}, got '{name}'; serve a map to add it")
    settings = world_settings(AdviseSettings(maps.get(name, name), ""))
    occupancy = map_from_settings(settings) if settings.domain == "building" else None
    world = world_from_settings(settings, occupancy)
    if world.n_states > MOST_STATES:
        raise InputError(
            f"building must have at most {MOST_STATES:,} places to walk, got {world.n_states:,} in '{name}'; "
            "serve a map of a part of it"
        )
    floor = floor_of_cells(world) if occupancy is None else floor_of(occupancy, world)
    named = _named_places(settings, world, floor, memory) if memory is not None and name in maps else {}
    if named:
        places, distance = np.array(list(named)), np.array([_distances(world, state) for state in named])
        names = tuple(named.values())
    else:
        places, distance = spread_places(name, world)
        names = tuple(f"place {number + 1}" for number in range(len(places))) if name in maps else PLACE_NAMES
    return WalkBuilding(name, world, names, places, distance, visible_places(floor, world, REACH))


def _named_places(settings: WorldSettings, world: GridWorld, floor: Floor, memory: Memory) -> dict[int, str]:
    """Names that memory knows in a building, by state; a point where this map has no free place is left out."""
    place = recognised_place(settings, world, floor.occupancy, memory)
    found = dict[int, str]()
    for name, point in list(NamedPlaces.of(place).points(memory).items())[:MOST_NAMES]:
        try:
            found.setdefault(floor.state_at(name, point), name)
        except InputError:
            continue  # it is blocked in this map
    return found


def spread_places(name: str, world: GridWorld) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
    """Places far from each other, each the farthest state from all places before it; and the moves to them."""
    first = int(stream(0, "walk places", name).integers(world.n_states))
    chosen = [int(np.argmax(_distances(world, first)))]
    moves = [_distances(world, chosen[0])]
    while len(chosen) < min(len(PLACE_NAMES), world.n_states - 1):
        chosen.append(int(np.argmax(np.min(moves, axis=0))))
        moves.append(_distances(world, chosen[-1]))
    return np.array(chosen), np.array(moves)


def _distances(world: GridWorld, goal: int) -> NDArray[np.int32]:
    place = np.zeros(world.n_states, np.int8)
    place[goal] = GOAL
    return goal_distances(world.neighbour, place)
