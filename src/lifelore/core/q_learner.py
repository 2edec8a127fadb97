"""`QLearning`: the settings of ε-greedy Q-learning, and a run of it on tables in bounded chunks."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lifelore.core.curve import Curve, new_curve
from lifelore.core.errors import InputError
from lifelore.core.mdp import Tables
from lifelore.core.q_learning import Learner, Rows, Schedule, learn, new_learner, uniform_rows

CHUNK = 1_000_000
"""Steps between two looks at the outside world: well under 0.2 s, so Ctrl-C is heard."""


@dataclass(frozen=True)
class QLearning:
    """ε-greedy Q-learning; with rows from an action prior it is ε-QSAP or ε-QPAP (Alg. 2, 4).

    Parameters
    ----------
    episodes, max_steps : int
        Episodes of a task, and steps of an episode at most; ≥ 1.
    learning_rate : float
        α in [0, 1], constant.
    epsilon, epsilon_decay, epsilon_floor : float
        ε = max(floor, epsilon · decay^episode), all in [0, 1].

    Examples
    --------
    >>> import numpy as np
    >>> from lifelore.domains import make_world
    >>> task = make_world("lattice", size=7).task(goal=0)
    >>> tables, random = task.tables(), np.random.default_rng(1)
    >>> learner, curve = QLearning(episodes=200).learn(tables, 0.95, world=random, own=random)
    >>> bool(curve.returns[-20:].mean() > curve.returns[:20].mean())
    True
    """

    episodes: int = 1000
    max_steps: int = 1000
    learning_rate: float = 0.5
    epsilon: float = 1.0
    epsilon_decay: float = 0.98
    epsilon_floor: float = 0.01

    def __post_init__(self) -> None:
        for name in ("episodes", "max_steps"):
            if getattr(self, name) < 1:
                raise InputError(f"{name} must be at least 1, got {getattr(self, name)}")
        for name in ("learning_rate", "epsilon", "epsilon_decay", "epsilon_floor"):
            if not 0 <= getattr(self, name) <= 1:
                raise InputError(f"{name} must lie in [0, 1], got {getattr(self, name)}")

    def schedule(self, discount: float) -> Schedule:
        """ε and α of each episode, as the kernel takes them."""
        decayed = self.epsilon * self.epsilon_decay ** np.arange(self.episodes)
        return Schedule(
            np.maximum(self.epsilon_floor, decayed),
            np.full(self.episodes, float(self.learning_rate)),
            self.max_steps,
            float(discount),
        )

    def learn(
        self,
        tables: Tables,
        discount: float,
        *,
        world: np.random.Generator,
        own: np.random.Generator,
        rows: Rows | None = None,
        watch: Callable[[Learner, Curve], bool] | None = None,
    ) -> tuple[Learner, Curve]:
        """Learn one task.

        Parameters
        ----------
        tables : Tables
        discount : float
            γ in [0, 1).
        world, own : numpy generators
            Where episodes start and outcomes fall; the learner's own choices. Methods that are compared
            share the world's.
        rows : Rows, optional
            What exploration and ties follow; default uniform.
        watch : callable, optional
            Called between chunks; a true answer ends learning early.

        Returns
        -------
        learner, curve : Learner, Curve
        """
        rows = rows or uniform_rows(tables)
        learner = new_learner(int(rows.q_row.max()) + 1, tables.n_actions, world, own)
        curve, schedule = new_curve(self.episodes), self.schedule(discount)
        while learn(tables, rows, schedule, learner, curve, CHUNK):
            if watch and watch(learner, curve):
                break
        return learner, curve
