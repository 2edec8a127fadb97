"""The tasks of a life: goals hidden by seed and task number, so that a continued life never repeats itself."""

import numpy as np

from lifelore.agent.live.life_settings import LifeSettings
from lifelore.agent.live.transitions import frame_key
from lifelore.core.errors import InputError
from lifelore.core.mdp import Task
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld


class TaskStream:
    """Task number to task, in one world."""

    def __init__(self, world: GridWorld, settings: LifeSettings) -> None:
        self.world, self.seed = world, settings.seed
        self._start = _start_state(world, settings.start)
        places = np.delete(np.arange(world.n_states), [] if self._start is None else self._start)
        if settings.destinations > len(places):
            raise InputError(
                f"destinations must be at most the {len(places)} free places of this world, "
                f"got {settings.destinations}"
            )
        if settings.destinations:
            # Drawn over all cells of the frame: a map that changed in places keeps its destinations.
            order = stream(self.seed, "destinations", frame_key(world)).permutation(world.state_of.size)
            states = world.state_of.ravel()[order]
            places = states[np.isin(states, places)][: settings.destinations]
        self._places = places

    def goal(self, index: int) -> int:
        """The hidden goal of task `index`."""
        return int(stream(self.seed, "task", index, "goal").choice(self._places))

    def task(self, index: int) -> Task:
        """Task `index`."""
        starts = None if self._start is None else np.array([self._start], np.int32)
        return self.world.task(self.goal(index), starts)

    def world_stream(self, index: int) -> np.random.Generator:
        """Where episodes start; the same for every agent."""
        return stream(self.seed, "task", index, "world")

    def own_stream(self, index: int) -> np.random.Generator:
        """An agent's own choices; equal streams make the comparison a paired one."""
        return stream(self.seed, "task", index, "own")


def _start_state(world: GridWorld, start: tuple[int, int] | None) -> int | None:
    if start is None:
        return None
    row, column = start
    inside = 0 <= row < world.shape[0] and 0 <= column < world.shape[1]
    if not inside or world.state_of[row, column] < 0:
        raise InputError(
            f"start must be a free cell ROW,COL of this world ({world.shape[0]} rows, {world.shape[1]} columns), "
            f"got {row},{column}"
        )
    return int(world.state_of[row, column])
