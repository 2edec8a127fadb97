"""A tabletop job that is replayed from an `OutcomeTree`: equal actions on a tray are simulated once.

Lives of several agents on the same trays, and the episodes of a task, then share their physics. Returns,
observations and pictures are those of a `TabletopJob`.
"""

from collections.abc import Callable
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.domains.tabletop_job.best_return import Actions, OutcomeTree
from lifelore.domains.tabletop_job.job import HAND_OVER_BRISKLY, JobObservation, TabletopJob, reward_of
from lifelore.domains.tabletop_job.job_types import User

T = TypeVar("T")


class JobReplay:
    """A job as in `TabletopJob`, on the outcomes of a tree.

    Parameters
    ----------
    tree : OutcomeTree
        Of the tray and the gripper; shared between jobs, and grown by them.
    user : User
    """

    def __init__(self, tree: OutcomeTree, user: User) -> None:
        self.tree, self.user = tree, user
        self.actions: Actions = ()
        self.n_objects = len(tree.tray.shapes)
        self.n_actions = tree.n_actions

    @property
    def observation(self) -> JobObservation:
        """The present observation."""
        return self.tree.after(self.actions).state.observation

    def reset(self) -> JobObservation:
        """Back to the settled tray."""
        self.actions = ()
        return self.observation

    def available(self) -> NDArray[np.bool_]:
        """(n_actions,) whether each action can be taken now."""
        allowed = np.zeros(self.n_actions, np.bool_)
        allowed[list(self.tree.after(self.actions).available)] = True
        return allowed

    def step(self, action: int) -> tuple[JobObservation, float, bool]:
        """Take an action: observation, reward in points, and whether the job ended; errors as in `TabletopJob`."""
        allowed = self.tree.after(self.actions).available
        if action not in allowed:
            raise InputError(f"action must be one of {list(allowed)} now, got {action}; see available()")
        self.actions = (*self.actions, int(action))
        node = self.tree.after(self.actions)
        brisk = action // self.n_objects == HAND_OVER_BRISKLY
        assert node.events is not None, "an action was taken"
        reward = reward_of(self.user, node.events, brisk, self.tree.tray.target)
        return node.state.observation, reward, node.state.ended

    def seen(self, purpose: str, look: Callable[[TabletopJob], T]) -> T:
        """What `look` makes of the job as it is now; computed once for each purpose and sequence of actions."""
        return self.tree.seen(self.actions, purpose, look)
