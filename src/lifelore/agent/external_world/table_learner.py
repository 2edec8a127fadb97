"""Learns the policy of one task by Q-learning over a table, guided by the action prior or not.

States and contexts get their rows when they are first met. Learners by name:

- ``"textbook"`` learns each step once, at a constant rate, as `lifelore.core.learning.q_learning` does;
- ``"q"`` replays each episode backwards when it ends, so that a reward reaches the whole episode (Lin 1992);
- ``"model"`` also learns from remembered steps after each step (Dyna, Sutton 1990).
"""

from collections import defaultdict
from collections.abc import Callable, Hashable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import TRACE
from lifelore.agent.external_world.episode import Step
from lifelore.agent.external_world.useful_actions import EpisodeReturns, useful_actions
from lifelore.agent.live.life_settings import PriorSettings
from lifelore.core.compiled.random_state import random_state
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import cumulative, epsilon_greedy

Array = NDArray[np.float64]

TABLES = {"q": (True, 0), "model": (True, 20), "textbook": (False, 0)}
"""Learners by name: whether episodes are replayed, and the number of remembered steps after each step."""
HALF, LEAST_RATE = 10.0, 0.2
"""Times that a move is learnt until its rate is a half, and the least share of the first rate, with replay."""
TRUST = 0.5
"""Share of a cautious learner's exploration by the action prior in a state of which nothing was learnt: a new type
may want what none wanted before."""


class TableLearner:
    """A learner of one task.

    Parameters
    ----------
    n_actions : int
    prior : ActionPrior, optional
        Guides exploration; without it exploration is uniform.
    learning : QLearning
    discount : float
    guidance : PriorSettings
    generator : numpy generator
    name : str
        Of `TABLES`.
    cautious : bool
        Whether the prior is trusted by half only, and not at all in every second episode as long as all episodes
        earn the same. Once the values of a state's actions differ, the prior counts as one try of each action
        beside all that tasks of the type have made there: a known type explores what it has not tried.
    start : mapping of states to (n_actions,) values, optional
        Values to start from; 0 by default.
    met : callable, optional
        ``met(state, action)``: how often tasks of the type have met a move; what is well known changes slowly.

    Attributes
    ----------
    q : dict of state to (1, n_actions) float64
    visited : dict of (state, context code) to float
        In which it acted, in the order met, and how often tasks of the type have acted there.
    returns : EpisodeReturns
    """

    def __init__(
        self,
        n_actions: int,
        prior: ActionPrior | None,
        learning: QLearning,
        discount: float,
        guidance: PriorSettings,
        generator: np.random.Generator,
        name: str = "textbook",
        *,
        cautious: bool = False,
        start: Mapping[Any, Array] | None = None,
        met: Callable[[Any, int], float] | None = None,
    ) -> None:
        self.n_actions, self.prior, self.guidance, self.generator = n_actions, prior, guidance, generator
        self.replays, self.planned = TABLES[name]
        self.rate, self.discount, self.cautious = learning.learning_rate, discount, cautious
        self.random = random_state(generator)
        self.q: dict[Any, Array] = defaultdict(lambda: np.zeros((1, n_actions)))
        self.q.update({state: row[None].copy() for state, row in (start or {}).items()})
        self.visited: dict[tuple[Any, int], float] = {}
        self.returns = EpisodeReturns(n_actions)
        self.remembered: list[Step] = []
        self._epsilons = learning.schedule(discount).epsilon.tolist()
        self._even = cumulative(np.full((1, n_actions), 1 / n_actions)), np.ones((1, n_actions))
        self._rows: dict[int, tuple[Array, Array]] = {}
        self._guided = True
        self._met, self._number = met or (lambda state, action: 0.0), dict[tuple[Any, int], float]()

    # ---- act ---------------------------------------------------------------------------------------

    def knows(self, state: Hashable) -> bool:
        """Whether it has acted in a state, or learnt there."""
        return state in self.q

    def act(self, state: Hashable, context: int, explore: bool = True) -> int:
        """The ε-greedy action (Alg. 2, line 5), or the greedy one."""
        epsilon = self._epsilons[min(len(self.returns.returns), len(self._epsilons) - 1)] if explore else 0.0
        tries, (explored, ties) = self._visit(state, context), self._even
        if self.prior is not None and self._is_guided(state, tries):
            if context not in self._rows:
                self._rows[context] = self._rows_of(self.prior, context)
            explored, ties = self._rows[context]
        return epsilon_greedy(self.q[state], 0, explored, ties, 0, epsilon, self.random)

    def _is_guided(self, state: Hashable, tries: float) -> bool:
        """Whether the prior has the say now: always, or ever more rarely where the values of actions differ."""
        if not self.cautious:
            return True
        values = self.q[state][0]
        weight = tries if values.min() < values.max() else 0.0
        trust = TRUST * self.n_actions / (self.n_actions + weight)
        return self._guided and self.generator.random() < trust

    def _visit(self, state: Hashable, context: int) -> float:
        """Count a visit of a state; how often tasks of the type have acted there before."""
        tries = self.visited.get((state, context))
        if tries is None:
            tries = sum(self._met(state, action) for action in range(self.n_actions))
        self.visited[state, context] = tries + 1
        return tries

    def _rows_of(self, prior: ActionPrior, context: int) -> tuple[Array, Array]:
        """Cumulative exploration probabilities and tie weights, both (1, n_actions)."""
        probs = prior.probs([context], self.guidance.form, generator=self.generator)
        ties = np.maximum(probs, TRACE) if self.guidance.ties == "prior" else np.ones_like(probs)
        return cumulative(probs), ties

    # ---- learn -------------------------------------------------------------------------------------

    def observe(self, step: Step) -> None:
        """Learn from a step, and from remembered steps."""
        self._learn(step)
        if self.planned:
            self.remembered.append(step)
            for place in self.generator.integers(len(self.remembered), size=self.planned).tolist():
                self._learn(self.remembered[place])

    def end_episode(self, steps: list[Step], earned: float, ended: bool) -> None:
        """Learn the episode once more, backwards."""
        if self.replays:
            for step in reversed(steps):
                self._learn(step)
        self.returns.add(steps, earned, ended)
        returns = self.returns.returns
        self._guided = not self.cautious or min(returns) < max(returns) or len(returns) % 2 == 0

    def take_over(self, steps: list[Step]) -> None:
        """Learn steps that another player has made."""
        for step in reversed(steps):
            self._visit(step.state, step.context)
            self._learn(step)
        self.remembered += steps

    def _learn(self, step: Step) -> None:
        # A state that it only arrived in gets no row: it is not known.
        ahead = None if step.ended else self.q.get(step.following)
        future = 0.0 if ahead is None else self.discount * float(ahead.max())
        q = self.q[step.state]
        rate = self._falling_rate((step.state, step.action)) if self.replays else self.rate
        q[0, step.action] += rate * (step.reward + future - q[0, step.action])

    def _falling_rate(self, move: tuple[Any, int]) -> float:
        """The learning rate of a move, which falls with the number of times that it was learnt."""
        number = self._number[move] if move in self._number else self._met(*move)
        self._number[move] = number + 1
        return self.rate * max(LEAST_RATE, 1 / (1 + number / HALF))

    # ---- what was learnt ---------------------------------------------------------------------------

    def policy(self) -> dict[Any, Array]:
        """State to its values (n_actions,); the best action is the policy."""
        return {state: row[0] for state, row in self.q.items()}

    def best(self) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Contexts (n,) of the visited states, and their useful actions (n, n_actions), see `useful_actions`."""
        contexts = np.array([context for _, context in self.visited], np.int64)
        q = np.array([self.q[state][0] for state, _ in self.visited]).reshape(-1, self.n_actions)
        return contexts, useful_actions(q, list(self.visited), self.returns)
