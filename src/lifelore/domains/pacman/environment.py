"""Pacman as a Gymnasium environment; `lifelore.domains` registers it."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium import spaces

from lifelore.core.errors import InputError
from lifelore.core.mdp import COLLISION
from lifelore.core.streams import stream
from lifelore.domains.checked_environment import CheckedEnvironment
from lifelore.domains.pacman.pacman import N_ACTIONS, STRATEGIES, PacmanMaze, PacmanTask, step
from lifelore.domains.task_environment import TaskEnvironment


class PacmanEnvironment(TaskEnvironment):
    """The thesis's Pacman (§4.6.3): four items of food, and a ghost seen only in line of sight.

    One uniform number is drawn for each reset and each step, so a rollout equals one through the task's tables
    under the same numbers, bit for bit.

    ## Action Space
    ``Discrete(4)``: north, south, east, west; into a wall is to stay.

    ## Observation Space
    ``Discrete(n)``: the number of own cell, foods left, and the ghost's cell if it is in line of sight.

    ## Rewards
    10 for a food, 100 more for the last, -100 for meeting the ghost.

    ## Starting State
    Pacman in the centre, all foods there, the ghost anywhere else on its way, each place as likely;
    ``reset(options={"state": s})`` starts in hidden state s.

    ## Episode End
    All foods are eaten, or the ghost is met; truncated after 200 steps.

    ## Arguments
    `strategy`: of the ghost, ``"top row"``, ``"clockwise"``, ``"anticlockwise"`` or ``"random"``; None draws one
    from `seed`. `rows`, `columns`: of the maze, odd, 7. `foods`: four cells' numbers; None draws them from `seed`.
    `seed`: of the task.

    ``info`` has ``"state"``, the hidden state, which a player must not look at, and ``"collision"``, whether the
    last move was into a wall.
    """

    def __init__(
        self,
        strategy: str | None = None,
        rows: int = 7,
        columns: int = 7,
        foods: Sequence[int] | None = None,
        seed: int = 0,
    ) -> None:
        CheckedEnvironment.__init__(self)
        maze = PacmanMaze(rows, columns)
        foods = maze.draw_foods(stream(seed, "foods")) if foods is None else tuple(foods)
        strategy = str(stream(seed, "strategy").choice(STRATEGIES)) if strategy is None else strategy
        self.task: PacmanTask = PacmanTask(maze, foods, strategy)  # pyright: ignore[reportIncompatibleVariableOverride]
        self.action_space = spaces.Discrete(N_ACTIONS)
        self.observation_space = spaces.Discrete(self.task.n_observations)
        # The plain function: one call from Python costs less than entering compiled code.
        self._step = getattr(step, "py_func", step)
        self._state: int | None = None

    def _observed(self) -> int:
        return int(self.task.observation_of[self._state])

    def _info(self, event: int) -> dict[str, Any]:
        return {"state": self._state, "collision": bool(event & COLLISION)}

    def _check_state(self, state: Any) -> int:
        whole = isinstance(state, (int, np.integer)) and not isinstance(state, bool)
        first = self.task.n_states // 16
        if not whole or not first <= state < self.task.n_states:
            raise InputError(
                f"options['state'] must be a state in [{first}, {self.task.n_states}), those with food left; "
                f"got {state!r}"
            )
        return int(state)
