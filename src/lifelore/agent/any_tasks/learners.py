"""What acts in a task: a learner by table, or a policy of the user's learner."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.external_world.episode import Step
from lifelore.agent.external_world.table_learner import TABLES, TableLearner
from lifelore.agent.external_world.useful_actions import EpisodeReturns
from lifelore.core.errors import InputError

Learner = Callable[[Any, ActionPrior, Any], Callable[[Any], int]]
"""``learner(env, prior, start) -> policy``: the environment, whose episodes it may play; the action prior by
code of the features; and the policy to start from, or None. The policy gives an action for an observation."""


def checked_learner(learner: "str | Learner") -> "str | Learner":
    """The learner; InputError where no learner has this name."""
    if not callable(learner) and learner not in TABLES:
        raise InputError(f"learner must be {', '.join(TABLES)} or a function, got {learner!r}")
    return learner


class FixedPolicy:
    """A policy of the user's learner, which learns nothing more here and acts as a `TableLearner` does.

    Parameters
    ----------
    function : callable
        Observation to an action of the environment.
    observation : callable
        The present observation, without arguments.
    first_action : int
        The environment's number of the first action.
    n_actions : int
    """

    def __init__(
        self, function: Callable[[Any], int], observation: Callable[[], Any], first_action: int, n_actions: int
    ) -> None:
        self.function, self.observation, self.first_action = function, observation, first_action
        self.returns = EpisodeReturns(n_actions)
        self.visited: dict[tuple[int, int], None] = {}

    def knows(self, state: int) -> bool:
        """Always: the user's policy says what it does anywhere."""
        return True

    def act(self, state: int, context: int, explore: bool) -> int:
        """The policy's action for the present observation."""
        return int(self.function(self.observation())) - self.first_action

    def observe(self, step: Step) -> None:
        """Nothing is learnt."""

    def end_episode(self, steps: list[Step], earned: float, ended: bool) -> None:
        """Count the actions of the episode for the action prior."""
        self.visited.update(dict.fromkeys((step.state, step.context) for step in steps))
        self.returns.add(steps, earned, ended)

    def policy(self) -> Any:
        """The user's policy."""
        return self.function

    def best(self) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Contexts (n,) of the visited states, and the actions taken in the best tenth of the episodes."""
        visited = list(self.visited)
        return np.array([context for _, context in visited], np.int64), self.returns.taken_in_best(visited)


Player = TableLearner | FixedPolicy
"""What acts in a task, and learns from each move that it makes."""
