"""`QLearning`: the settings of ε-greedy Q-learning, and runs on tables in chunks."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.learning.curve import Curve, new_curve
from lifelore.core.learning.q_learning import (
    QLearner,
    Rows,
    Schedule,
    learn,
    new_learner,
    uniform_rows,
)
from lifelore.core.mdp import Tables
from lifelore.core.streams import stream

CHUNK = 1_000_000
"""Steps between two checks for Ctrl-C and for `watch`: well under 0.2 s."""
DEFAULT_CAP = 1000
"""Episodes of a task, and steps of an episode, where `QLearning` does not give them."""


@dataclass(frozen=True)
class QLearning:
    """ε-greedy Q-learning; with rows from an action prior it is ε-QSAP or ε-QPAP (Alg. 2, 4).

    Parameters
    ----------
    episodes : int, optional
        Maximum number of episodes of a task, from 1 to 10⁸; 1,000.
    max_steps : int, optional
        Maximum number of steps of an episode, from 1 to 10⁹; 1,000.
    learning_rate : float
        Learning rate α of Q-learning, in [0, 1].
    epsilon : float
        Exploration rate ε of the first episode of Q-learning, in [0, 1].
    epsilon_decay : float
        Factor of ε after each episode, in [0, 1].
    epsilon_floor : float
        Least exploration rate ε, in [0, 1].
    annealed : bool
        Whether ε and α fall by equal steps to 0 over the episodes; ``epsilon_decay`` and ``epsilon_floor`` are
        then not read. The schedule that the thesis prints (§4.6.3) also begins with ε = α = 0.5.

    Raises
    ------
    InputError
        A setting is out of its range.

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

    episodes: int | None = None
    max_steps: int | None = None
    learning_rate: float = 0.5
    epsilon: float = 1.0
    epsilon_decay: float = 0.98
    epsilon_floor: float = 0.01
    annealed: bool = False

    def __post_init__(self) -> None:
        for name, value, most in (("episodes", self.episodes, 10**8), ("max_steps", self.max_steps, 10**9)):
            if value is not None and not (isinstance(value, int | np.integer) and 1 <= value <= most):
                raise InputError(f"{name} must be a whole number from 1 to {most:,}, got {value}")
        for name in ("learning_rate", "epsilon", "epsilon_decay", "epsilon_floor"):
            if not 0 <= getattr(self, name) <= 1:
                raise InputError(f"{name} must lie in [0, 1], got {getattr(self, name)}")

    @property
    def episode_cap(self) -> int:
        """``episodes``; 1,000 where they are not given."""
        return DEFAULT_CAP if self.episodes is None else self.episodes

    @property
    def step_cap(self) -> int:
        """``max_steps``; 1,000 where they are not given."""
        return DEFAULT_CAP if self.max_steps is None else self.max_steps

    def schedule(self, discount: float) -> Schedule:
        """ε and α of each episode, as the kernel takes them."""
        episode = np.arange(self.episode_cap)
        left = 1 - episode / self.episode_cap if self.annealed else np.ones(self.episode_cap)
        decayed = np.maximum(self.epsilon_floor, self.epsilon * self.epsilon_decay**episode)
        epsilon = self.epsilon * left if self.annealed else decayed
        return Schedule(epsilon, self.learning_rate * left, self.step_cap, float(discount))

    def learn(
        self,
        tables: Tables,
        discount: float,
        *,
        world: np.random.Generator | None = None,
        own: np.random.Generator | None = None,
        rows: Rows | None = None,
        seed: int = 0,
        watch: Callable[[QLearner, Curve], bool] | None = None,
    ) -> tuple[QLearner, Curve]:
        """Learn one task.

        Parameters
        ----------
        tables : Tables
        discount : float
            γ in [0, 1].
        world, own : numpy generators, optional
            Draws of starts and outcomes; draws of the learner. Compared methods share the world's. By default two
            streams of `seed`.
        rows : Rows, optional
            Exploration probabilities and tie weights; default uniform.
        seed : int
        watch : callable, optional
            Called between chunks; a true answer ends learning early.

        Returns
        -------
        learner, curve : Learner, Curve

        Raises
        ------
        InputError
            `discount` is out of range, `rows` comes from elsewhere, or tables made by hand break a rule.
        """
        if not 0 <= discount <= 1:
            raise InputError(f"discount must lie in [0, 1], got {discount}")
        if not isinstance(rows, Rows | None):
            raise InputError(f"rows must come from prior_rows or feature_rows, got {type(rows).__name__}")
        tables, rows = tables.checked(), rows or uniform_rows(tables)
        world, own = world or stream(seed, "world"), own or stream(seed, "learner")
        learner = new_learner(int(rows.q_row.max()) + 1, tables.n_actions, world, own)
        curve, schedule = new_curve(self.episode_cap), self.schedule(discount)
        while learn(tables, rows, schedule, learner, curve, CHUNK):
            if watch and watch(learner, curve):
                break
        return learner, curve
