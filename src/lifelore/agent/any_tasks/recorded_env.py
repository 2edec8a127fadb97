"""The environment of a task as a learner of the user sees it: it records each move and return."""

from collections.abc import Callable
from typing import Any

import gymnasium

from lifelore.agent.any_tasks.moves import MoveCodes
from lifelore.agent.external_world.episode import Step, check_reward, discounted
from lifelore.agent.external_world.gymnasium_world import GymnasiumWorld


class RecordedEnv(gymnasium.Wrapper):
    """A user's environment that records the steps of the episodes played in it.

    Parameters
    ----------
    world : GymnasiumWorld
        Over the environment.
    codes : MoveCodes
    task : int
    discount : float
    record : callable
        Called as ``record(steps, earned, ended)`` after each episode.
    """

    def __init__(
        self,
        world: GymnasiumWorld,
        codes: MoveCodes,
        task: int,
        discount: float,
        record: Callable[[list[Step], float, bool], None],
    ) -> None:
        super().__init__(world.env)
        self.world, self.codes, self.task, self.discount, self.record = world, codes, task, discount, record
        self._steps: list[Step] = []

    def reset(self, **options: Any) -> tuple[Any, dict]:
        """Begin an episode; one that was not finished is recorded as it is."""
        self._finish(ended=False)
        observation, info = self.env.reset(**options)
        self._state, self._reward = self.world.see(observation), 0.0
        return observation, info

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict]:
        """Take a step, and record it."""
        state = self.codes.states[self._state]
        context = self.codes.states[self.world.context(self._state, self._reward)]
        observation, reward, terminated, truncated, info = self.env.step(action)
        self._state, self._reward = self.world.see(observation), float(reward)
        number = int(action) - self.world.first_action
        check_reward(self._reward, number, self.task)
        step = Step(state, context, number, self._reward, self.codes.states[self._state], bool(terminated))
        self._steps.append(step)
        if terminated or truncated:
            self._finish(bool(terminated))
        return observation, reward, terminated, truncated, info

    def _finish(self, ended: bool) -> None:
        if self._steps:
            self.record(self._steps, discounted(self._steps, self.discount), ended)
            self._steps = []
