"""The tasks of a life, drawn by seed and task number, so that a continued life gets new tasks."""

import numpy as np

from lifelore.agent.live.life_settings import LifeSettings
from lifelore.agent.live.transitions import frame_key
from lifelore.core.errors import InputError
from lifelore.core.mdp import Task
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld


class TaskStream:
    """Makes the task of each number, in one world.

    `frame` is the key of the grid that the world shares with other maps of its building; default: its own. `start`
    is the state in which every episode starts; default: any.
    """

    def __init__(
        self, world: GridWorld, settings: LifeSettings, frame: str | None = None, start: int | None = None
    ) -> None:
        self.world, self.seed = world, settings.seed
        self._start = start
        places = np.delete(np.arange(world.n_states), [] if self._start is None else self._start)
        if settings.destinations > len(places):
            raise InputError(
                f"destinations must be at most the {len(places)} free places of this world, "
                f"got {settings.destinations}; use fewer"
            )
        if settings.destinations:
            # Drawn from all cells of the frame, so that a map with small changes has the same destinations.
            order = stream(self.seed, "destinations", frame or frame_key(world)).permutation(world.state_of.size)
            states = world.state_of.ravel()[order]
            places = states[np.isin(states, places)][: settings.destinations]
        self._places = places

    def goal(self, index: int) -> int:
        """State of the goal of task `index`, which the agents do not know."""
        return int(stream(self.seed, "task", index, "goal").choice(self._places))

    def task(self, index: int, goal: int | None = None) -> Task:
        """Goal and starts of task `index`; the `goal` is drawn if it is not given."""
        starts = None if self._start is None else np.array([self._start], np.int32)
        return self.world.task(self.goal(index) if goal is None else goal, starts)

    def world_stream(self, index: int) -> np.random.Generator:
        """Random stream of the episodes' starts; the same for every agent."""
        return stream(self.seed, "task", index, "world")

    def own_stream(self, index: int) -> np.random.Generator:
        """Random stream of an agent's choices; equal for all agents, which makes their comparison paired."""
        return stream(self.seed, "task", index, "own")
