"""Mean value of the best known way to the goal, kept up to date as a model of the world grows.

A task's learner is looked at every few steps: what is the way it knows worth? Evaluating every state each time
costs as much as the world is large. Learning only adds moves, and moves only shorten ways, so the distances to
the goal are kept and mended where a new move shortens them; the mean is then a sum over distances:

    mean over starts of γ^(d - 1) · goal reward, d the start's distance to the goal, 0 where no way is known
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lifelore.core.learning.curve import GOALS, NEWS
from lifelore.core.learning.known_world import UNKNOWN, Model, add_moves, blank_ways, find_ways, known_policy
from lifelore.core.learning.model_learning import ALL_NEW, Explorer
from lifelore.core.mdp import TERMINAL, Tables
from lifelore.core.planning.planning import mean_start_value, policy_values


@dataclass
class KnownValue:
    """Mean value over a task's starts of going the best way that a model knows.

    The model may only learn between two calls of `update`, by `explore` with one explorer. Where values do not
    depend on distances alone (moves that cost, several goals, a remembered model that is not true of
    this world) every state is evaluated instead, as often as something new is known.

    Parameters
    ----------
    tables : Tables
        Deterministic: one outcome a move.
    model : Model
    explorer : Explorer
    discount : float
        γ in [0, 1).
    """

    tables: Tables
    model: Model
    explorer: Explorer
    discount: float
    _by_distance: NDArray[np.float64] | None = field(init=False, repr=False)
    _value: float = field(init=False, default=0.0, repr=False)

    def __post_init__(self) -> None:
        reward = _one_goal_reward(self.tables) if _is_true(self.model, self.tables) else None
        self._by_distance = None if reward is None else _values(reward, self.discount, self.tables.n_states)
        starts = None if reward is None else self.tables.starts
        self._ways = blank_ways(self.tables.n_states, self.tables.n_actions, starts)

    def update(self) -> float:
        """The value by now; differs from `exact` by rounding alone, relatively by less than 1e-12."""
        news = int(self.explorer.cursor[NEWS])
        if not self.explorer.cursor[GOALS]:
            return 0.0  # no way leads to a goal that was not seen
        if news:
            by_distance = self._by_distance
            self._value = self.exact() if by_distance is None else self._mended(news, by_distance)
            self.explorer.cursor[NEWS] = 0
        return self._value

    def exact(self) -> float:
        """The value by evaluating the greedy policy of what is known in every state."""
        policy = known_policy(self.model, self.explorer.place)
        return mean_start_value(self.tables, policy_values(self.tables, policy, self.discount))

    def _mended(self, news: int, by_distance: NDArray[np.float64]) -> float:
        target, place = self.model.target, self.explorer.place
        if news == ALL_NEW:
            find_ways(target, place, self._ways)
        else:
            add_moves(target, place, self.explorer.news[:news], self._ways)
        near = slice(int(self._ways.farthest[0]) + 1)
        return float(self._ways.starts_at[near] @ by_distance[near]) / len(self.tables.starts)


def _values(goal_reward: float, discount: float, n_states: int) -> NDArray[np.float64]:
    """(n_states + 1,) value of a state at each distance to the goal; at the goal there is nothing left to gain."""
    values = np.zeros(n_states + 1)
    values[1:] = goal_reward * discount ** np.arange(n_states)
    return values


def _is_true(model: Model, tables: Tables) -> bool:
    """Whether every known move leads where it leads in this world; learning then keeps it so."""
    return bool(((model.target == UNKNOWN) | (model.target == tables.next_state[:, :, 0])).all())


def _one_goal_reward(tables: Tables) -> float | None:
    """The reward at the only goal, where all moves into it end with it and no other that leads on ends or gives.

    Of several goals one not yet met may lie on the known way to another, and end the episode there.
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
