"""Any task as a Gymnasium environment: the same `step` that the tables are made from."""

from typing import Any

import numpy as np
from gymnasium import spaces

from lifelore.core.errors import InputError
from lifelore.core.mdp import COLLISION, TERMINAL, Task
from lifelore.domains.checked_environment import CheckedEnvironment


class TaskEnvironment(CheckedEnvironment):
    """A `Task` to be acted in.

    One uniform number is drawn for each reset and each step, so a rollout equals one through the task's
    tables under the same numbers, bit for bit.

    ## Action Space
    ``Discrete(n_actions)`` of the task's domain.

    ## Observation Space
    ``Discrete(n_states)``: the number of the state.

    ## Rewards
    Those of the task's `step`.

    ## Starting State
    One of the task's starts, each as likely; ``reset(options={"state": s})`` starts in state s.

    ## Episode End
    Where `step` says so; a time limit is the business of ``gymnasium.make``.

    ## Arguments
    `task`: the task. `render_mode`: None, or what a subclass offers.

    ``info["collision"]`` tells whether the last move was refused by the world.

    Examples
    --------
    >>> from lifelore import Task, make_world
    >>> env = TaskEnvironment(make_world("lattice", size=9).task(0))
    >>> observation, info = env.reset(seed=0)
    >>> env.action_space
    Discrete(4)
    """

    def __init__(self, task: Task, render_mode: str | None = None) -> None:
        super().__init__(render_mode)
        self.task = task
        self.action_space = spaces.Discrete(task.domain.n_actions)
        self.observation_space = spaces.Discrete(task.domain.n_states)
        # The plain function: one call from Python costs less than entering compiled code.
        self._step: Any = getattr(task.domain.step, "py_func", task.domain.step)
        self._state: int | None = None

    def _begin(self, options: dict[str, Any]) -> tuple[int, dict[str, Any]]:
        chosen, starts = options.get("state"), self.task.starts
        drawn = int(starts[int(self.np_random.random() * len(starts))])
        self._state = drawn if chosen is None else self._check_state(chosen)
        return self._observed(), self._info(0)

    def _advance(self, action: int) -> tuple[int, float, bool, dict[str, Any]]:
        state, reward, event = self._step(self.task.params, self._state, action, self.np_random.random())
        self._state = int(state)
        return self._observed(), reward, bool(event & TERMINAL), self._info(event)

    def _observed(self) -> int:
        """The observation of the present state."""
        assert self._state is not None
        return self._state

    def _check_state(self, state: Any) -> int:
        if isinstance(state, bool) or not isinstance(state, (int, np.integer)):
            raise InputError(f"options['state'] must be the number of a state, got {state!r}")
        if not 0 <= state < self.task.domain.n_states:
            raise InputError(f"options['state'] must lie in [0, {self.task.domain.n_states}), got {state}")
        return int(state)

    def _info(self, event: int) -> dict[str, Any]:
        return {"collision": bool(event & COLLISION)}
