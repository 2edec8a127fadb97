"""Result of one agent on one task: the numbers of the report and the arrays for the pictures."""

from dataclasses import dataclass, field, fields

import numpy as np
from numpy.typing import NDArray

from lifelore.core.learning.curve import Curve, new_curve

THRESHOLD = 0.8
"""Share of the optimal return at which a task counts as learnt (thesis §3.4.1, Fig. 3.3)."""


@dataclass
class TaskResult:
    """Result of one agent on one task.

    first_return : discounted return of the first episode
    collisions : refused moves until the threshold (or the cap)
    steps_to_goal : steps until the goal was found: entered; the cap if it never was
    steps_to_80, episodes_to_80 : steps and episodes until the greedy policy's exact value, averaged over the
        starts, is ≥ 80 % of the optimum; the cap (all episodes at full length) if it never is
    reached : whether the threshold was reached
    final_return : exact value of the greedy policy at the end
    policy : (n_states,) greedy action, -1 where none is known
    best : (n_states, n_actions) best or tied-best actions of the learnt policy; False in states without a policy
    curve : the episodes that began
    complete : number of episodes that ended; one less if the last was interrupted
    """

    first_return: float
    collisions: int
    steps_to_goal: int
    steps_to_80: int
    episodes_to_80: int
    reached: bool
    final_return: float
    policy: NDArray[np.int32] = field(repr=False)
    best: NDArray[np.bool_] = field(repr=False)
    curve: Curve = field(repr=False)
    complete: int = field(repr=False)

    def drop_arrays(self) -> None:
        """Drop the episodes and the arrays of the world's size."""
        self.policy, self.best = np.empty(0, np.int32), np.empty((0, 0), np.bool_)
        self.curve, self.complete = new_curve(0), 0

    def episodes(self) -> dict[str, NDArray]:
        """Measure to its value in each finished episode."""
        curve, n = self.curve, self.complete
        return {
            "return": curve.returns[:n],
            "steps": curve.steps[:n],
            "collisions": curve.collisions[:n],
            "reached": curve.reached[:n],
        }

    def to_dict(self) -> dict:
        """The numbers as JSON data: the fields that `repr` shows."""
        return {one.name: getattr(self, one.name) for one in fields(self) if one.repr}
