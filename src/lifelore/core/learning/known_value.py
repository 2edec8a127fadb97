"""Mean value of the best known path to the goal, as a model of the world grows.

A learner is evaluated every few steps. Where values depend on the distance to the goal alone, one search finds all
distances, and the mean is a sum over them:

    mean over starts of γ^(d - 1) · goal reward, d the start's distance to the goal, 0 where no path is known
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lifelore.core.learning.curve import GOALS, NEWS
from lifelore.core.learning.known_world import UNKNOWN, WorldModel, goal_distances, known_policy
from lifelore.core.learning.model_learning import ModelLearner
from lifelore.core.mdp import TERMINAL, Tables
from lifelore.core.planning.planning import mean_start_value, policy_values


@dataclass
class KnownValue:
    """Mean value, over a task's starts, of the best path that a model knows.

    Between two calls of `update` only `explore` with this learner may change the model. Where values do not depend
    on distances alone (moves that cost, several goals, a remembered model that differs from this world), every
    state is evaluated instead.

    Parameters
    ----------
    tables : Tables
        Deterministic: one outcome a move.
    model : Model
    learner : ModelLearner
    discount : float
        γ in [0, 1).
    """

    tables: Tables
    model: WorldModel
    learner: ModelLearner
    discount: float
    _by_distance: NDArray[np.float64] | None = field(init=False, repr=False)
    _value: float = field(init=False, default=0.0, repr=False)

    def __post_init__(self) -> None:
        reward = _one_goal_reward(self.tables) if _is_true(self.model, self.tables) else None
        self._by_distance = None if reward is None else _values(reward, self.discount, self.tables.n_states)

    def update(self) -> float:
        """The current value; differs from `exact` by rounding alone, relatively by less than 1e-12."""
        if not self.learner.cursor[GOALS]:
            return 0.0  # no path leads to an unknown goal
        if self.learner.cursor[NEWS]:
            self.learner.cursor[NEWS] = 0
            self._value = self.exact() if self._by_distance is None else self._mean(self._by_distance)
        return self._value

    def exact(self) -> float:
        """The value by evaluating the greedy policy of the known world in every state."""
        policy = known_policy(self.model, self.learner.place)
        return mean_start_value(self.tables, policy_values(self.tables, policy, self.discount))

    def _mean(self, by_distance: NDArray[np.float64]) -> float:
        distance = goal_distances(self.model.target, self.learner.place)
        return float(by_distance[distance[self.tables.starts]].mean())


def _values(goal_reward: float, discount: float, n_states: int) -> NDArray[np.float64]:
    """(n_states + 1,) value of a state at each distance to the goal; 0 at the goal, and at -1: no path."""
    return np.concatenate([[0.0], goal_reward * discount ** np.arange(n_states - 1), [0.0]])


def _is_true(model: WorldModel, tables: Tables) -> bool:
    """Whether every known move is true of this world; learning preserves this."""
    return bool(((model.target == UNKNOWN) | (model.target == tables.next_state[:, :, 0])).all())


def _one_goal_reward(tables: Tables) -> float | None:
    """The reward of the only goal; None unless all moves into it end the episode and no others end it or pay.

    Of several goals, an unknown one may lie on the known path to another and end the episode there.
    """
    next_state, reward, event = tables.next_state[:, :, 0], tables.reward[:, :, 0], tables.event[:, :, 0]
    ends, stays = event & TERMINAL > 0, next_state == np.arange(tables.n_states)[:, None]
    wins = ends & (reward > 0)
    goals, rewards = np.unique(next_state[wins]), np.unique(reward[wins])
    if len(goals) != 1 or len(rewards) != 1:
        return None
    others = ~wins & ~stays
    plain = not (others & (next_state == goals[0])).any() and not stays[wins].any()
    plain = plain and not (reward[others].any() or ends[others].any())
    return float(rewards[0]) if plain else None
