"""A building for people to walk in: its places, the sight from each state, experts who know the ways, and a walk.

The advisor is the better one of `lifelore advise`, which saves fewer steps before it begins. Thesis: §3.7.
"""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from examples.pages.walk.sight import visible_places
from lifelore.action.advice.advisor import BETTER, Advisor
from lifelore.action.advice.goal_model import extend_goal_models
from lifelore.agent.advise.advise import AdviseSettings, non_expert_models, world_settings
from lifelore.agent.advise.expert_trajectories import goal_models, trajectories
from lifelore.agent.advise.step_lines import NO_ACTION, StepLine
from lifelore.core.errors import InputError
from lifelore.core.learning.known_world import GOAL, goal_distances
from lifelore.core.streams import stream
from lifelore.domains.buildings.floor import Floor, floor_of
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, OccupancyMap
from lifelore.domains.grids.grid_world import MOVE_NAMES, GridWorld
from lifelore.domains.worlds import map_from_settings, world_from_settings

PLACE_NAMES = ("kitchen", "printer", "library", "workshop", "post room", "studio", "archive", "reception")
REACH = 6.0
"""Metres that a person sees; in a maze, cells. Larger makes the search easier."""
WALKS = 30
"""Number of experts' walks to each place; more give advice in more states."""
MOST_STATES = 20_000
"""Maximum number of states; the tables of the advisor take 3 kB each."""
SETTINGS = replace(BETTER, kappa=0.5, window=60, share=0.75, burst=15.0)
"""At most 0.75 of the steps are advised, from step 20 on, for up to 60 steps; the last 60 steps are evidence."""
NEVER = 1e9
"""κ in nats of an advisor that never advises."""


class Building:
    """A building for people to walk in.

    Parameters
    ----------
    name : str
        A ROS map (YAML), or a world's name and seed, ``"building:0"``.

    Attributes
    ----------
    world : GridWorld
    places : (n_places,) int64
        States of the places `PLACE_NAMES`, far from each other.
    distance : (n_places, n_states) int32
        Moves to each place.

    Raises
    ------
    NotFoundError, InputError, StoreError
        The map cannot be read, no world has the name, or the building is too large.
    """

    def __init__(self, name: str) -> None:
        settings = world_settings(AdviseSettings(name, ""))
        occupancy = map_from_settings(settings) if settings.domain == "building" else None
        world = self.world = world_from_settings(settings, occupancy)
        if world.n_states > MOST_STATES:
            raise InputError(
                f"building must have at most {MOST_STATES:,} places to walk, got {world.n_states:,} in '{name}'; "
                "give a map of a part of it"
            )
        self.name = name
        floor = _floor_of_cells(world) if occupancy is None else floor_of(occupancy, world)
        self._sight = visible_places(floor, world, REACH)
        self.places, self.distance = self._spread_places()
        steps = self._expert_steps()
        self._passed = np.zeros(world.n_states, np.bool_)
        self._passed[[step.state for step in steps if step.action != NO_ACTION]] = True
        models = extend_goal_models(
            goal_models(trajectories(steps, world), self.places.tolist(), world), world.neighbour
        )
        others = non_expert_models(world, [model.goals[0] for model in models])
        self.advisor = Advisor(models, others, SETTINGS)
        self.silent_advisor = Advisor(models, others, replace(SETTINGS, kappa=NEVER))

    def in_sight(self, state: int) -> NDArray[np.integer]:
        """The states in sight of a state, ascending."""
        return self._sight.indices[self._sight.indptr[state] : self._sight.indptr[state + 1]]

    def errand(self, random: np.random.Generator) -> tuple[int, int]:
        """Start and place (its number) of a walk.

        The start is out of sight of the place, and an expert has passed it: elsewhere nobody could advise the
        person. It is one of the farther half of these states.
        """
        place = int(random.integers(len(self.places)))
        passed = self._passed & (self.distance[place] > 0)
        hidden = passed.copy()
        hidden[self.in_sight(int(self.places[place]))] = False
        starts = np.flatnonzero(hidden if hidden.any() else passed)
        far = self.distance[place, starts]
        return int(random.choice(starts[far >= np.median(far)])), place

    def _spread_places(self) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
        """Places, each the farthest state from all places before it; and the moves to them."""
        n = self.world.n_states
        first = int(stream(0, "walk places", self.name).integers(n))
        chosen = [int(np.argmax(self._distances(first)))]
        moves = [self._distances(chosen[0])]
        while len(chosen) < min(len(PLACE_NAMES), n - 1):
            chosen.append(int(np.argmax(np.min(moves, axis=0))))
            moves.append(self._distances(chosen[-1]))
        return np.array(chosen), np.array(moves)

    def _distances(self, goal: int) -> NDArray[np.int32]:
        place = np.zeros(self.world.n_states, np.int8)
        place[goal] = GOAL
        return goal_distances(self.world.neighbour, place)

    def _expert_steps(self) -> list[StepLine]:
        """Steps of simulated experts, who walk a shortest way to each place from `WALKS` random states."""
        random, steps, neighbour = stream(0, "walk experts", self.name), [], self.world.neighbour
        for place, distance in enumerate(self.distance):
            for number, start in enumerate(random.choice(np.flatnonzero(distance > 0), WALKS)):
                agent, state = f"{place}/{number}", int(start)
                while distance[state] > 0:
                    nearer = (neighbour[state] >= 0) & (distance[neighbour[state]] == distance[state] - 1)
                    move = int(random.choice(np.flatnonzero(nearer)))
                    steps.append(StepLine(agent, state, move))
                    state = int(neighbour[state, move])
                steps.append(StepLine(agent, state, NO_ACTION))
        return steps


class Walk:
    """A walk of a person who looks for a place.

    Parameters
    ----------
    building : Building
    advice : bool
        Whether the rule can fire; the advisor watches in any case.
    seed : int
        Draws the errand.
    """

    def __init__(self, building: Building, advice: bool, seed: int) -> None:
        self.building, self.steps = building, 0
        self.state, self.place = building.errand(stream(seed, "walk errand", building.name))
        self.shortest = int(building.distance[self.place, self.state])
        self._advisor = building.advisor if advice else building.silent_advisor
        self._agent = self._advisor.watch()
        self._advice = self._advisor.consider(self._agent, self.state)

    def step(self, move: str) -> None:
        """Try a move; InputError where `move` is none of north, south, east and west."""
        if move not in MOVE_NAMES:
            raise InputError(f"move must be one of {', '.join(MOVE_NAMES)}, got {move!r}")
        number = MOVE_NAMES.index(move)
        self._advisor.observe(self._agent, self.state, number, self._advice.advise)
        after = int(self.building.world.neighbour[self.state, number])
        self.state = self.state if after < 0 else after
        self.steps += 1
        self._advice = self._advisor.consider(self._agent, self.state)

    def view(self) -> dict[str, Any]:
        """What the person sees, and the advice.

        Returns
        -------
        dict
            ``shape`` (rows, columns), ``goal`` (name of the place to find), ``shortest`` (moves), ``steps``;
            ``at``, the person's cell (row, column); ``open``, names of the moves that lead on; ``seen``, (row,
            column, bits) of the cells in sight, where bit k is set if the move k leads on; ``places`` in sight:
            {"name", "at"}; ``reached``; ``advise``, ``theta`` (of each move; None where no expert was),
            ``p_normal``, ``gain`` and ``kappa`` in nats.
        """
        building, world, advice = self.building, self.building.world, self._advice
        states = building.in_sight(self.state)
        bits = ((world.neighbour[states] >= 0) << np.arange(len(MOVE_NAMES))).sum(axis=1)
        leads = world.neighbour[self.state] >= 0
        return {
            "shape": list(world.shape), "goal": PLACE_NAMES[self.place], "shortest": self.shortest,
            "steps": self.steps, "at": world.cells[self.state].tolist(),
            "open": [name for name, on in zip(MOVE_NAMES, leads, strict=True) if on],
            "seen": np.column_stack([world.cells[states], bits]).tolist(),
            "places": [
                {"name": PLACE_NAMES[place], "at": world.cells[state].tolist()}
                for place, state in enumerate(building.places) if state in states
            ],
            "reached": bool(self.state == building.places[self.place]), "advise": advice.advise,
            "theta": advice.theta.tolist() if advice.theta.any() else None,
            "p_normal": advice.p_normal, "gain": advice.gain, "kappa": SETTINGS.kappa,
        }  # fmt: skip


def _floor_of_cells(world: GridWorld) -> Floor:
    """The floor of a maze: a pixel for each cell, solid where there is no state."""
    free = world.state_of >= 0
    occupancy = OccupancyMap(np.where(free, FREE, OCCUPIED).astype(np.uint8), world.frame.cell, world.frame.origin)
    return Floor(occupancy, world.state_of, ~free, 0.0, world.neighbour)
