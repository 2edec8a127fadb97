"""What one agent's life through one task leaves: the numbers, and the arrays that pictures are made from."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lifelore.core.learning.curve import Curve, new_curve

THRESHOLD = 0.8
"""Share of the optimal return at which a task counts as learnt (thesis §3.4.1, Fig. 3.3)."""
CHECK_EVERY = 100
"""Steps between looks at the greedy policy's exact value; the same for every agent."""


@dataclass
class TaskResult:
    """One task of one agent.

    first_return : discounted return of the first episode
    collisions : refused moves until the threshold (or the cap)
    steps_to_80, episodes_to_80 : until the greedy policy's exact value, averaged over starts, is ≥ 80 % of
        optimal; where it never is, the cap: all episodes at their full length
    reached : whether it ever was
    final_return : that exact value at the end
    policy : (n_states,) greedy action, -1 where none is known
    best : (n_states, n_actions) which actions the learnt policy holds best; rows it does not know are False
    trace : (n_checks, 2) steps and share of optimal at each check
    curve : the episodes begun
    complete : how many of them ended; fewer only where the last was broken off
    """

    first_return: float
    collisions: int
    steps_to_80: int
    episodes_to_80: int
    reached: bool
    final_return: float
    policy: NDArray[np.int32] = field(repr=False)
    best: NDArray[np.bool_] = field(repr=False)
    trace: NDArray[np.float64] = field(repr=False)
    curve: Curve = field(repr=False)
    complete: int = field(repr=False)

    def drop_arrays(self) -> None:
        """Forget the policy, which is as large as the world, and the episodes."""
        self.policy, self.best = np.empty(0, np.int32), np.empty((0, 0), np.bool_)
        self.curve, self.complete = new_curve(0), 0

    def to_dict(self) -> dict:
        """The numbers as plain data."""
        return {
            "first_return": self.first_return,
            "collisions": self.collisions,
            "steps_to_80": self.steps_to_80,
            "episodes_to_80": self.episodes_to_80,
            "reached": self.reached,
            "final_return": self.final_return,
        }


class Stopped(Exception):
    """The person asked to stop; the task in progress is given up."""
