"""Simulated logs of `bench evaluation`, and the exact values of the policies that it evaluates on them."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.evaluation.importance_weights import decision_numbers

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

N_TYPES, N_POLICIES, N_USERS = 3, 4, 150
FIRST = 3
"""Decisions that every user has at least, and that the rule is evaluated on."""
MORE = 3.0
"""Mean number of further decisions of a user."""


@dataclass(frozen=True, eq=False)
class SimulatedLog:
    """Decisions, one a row, a user's in order of time.

    users, policies : (n,) int64
    outcomes : (n,) float64, 0 or 1
    probability : (n,) float64
        Of the logged policy.
    rule : (n, N_POLICIES) float64
        Probabilities of belief sampling after the user's earlier outcomes.
    """

    users: Numbers
    policies: Numbers
    outcomes: Array
    probability: Array
    rule: Array

    def first(self, n: int) -> "SimulatedLog":
        """The first n decisions of each user."""
        rows = decision_numbers(self.users) < n
        return SimulatedLog(*(getattr(self, name)[rows] for name in self.__dataclass_fields__))


@dataclass(frozen=True, eq=False)
class Study:
    """Users of hidden types.

    prior : (N_TYPES,) float64
    chance : (N_TYPES, N_POLICIES) float64
        Probability of the outcome 1.
    """

    prior: Array
    chance: Array

    @classmethod
    def drawn(cls, generator: np.random.Generator) -> Self:
        """A random study."""
        return cls(generator.dirichlet(np.full(N_TYPES, 3.0)), generator.beta(1.0, 1.0, (N_TYPES, N_POLICIES)))

    def sampling(self, belief: Array) -> Array:
        """Probability that belief sampling takes each policy, (n, N_POLICIES), of beliefs (n, N_TYPES)."""
        return belief @ np.eye(N_POLICIES)[self.chance.argmax(axis=1)]

    def log(self, generator: np.random.Generator, explore: float) -> SimulatedLog:
        """Decisions by belief sampling, a share of them drawn from all policies; 1: all."""
        types = generator.choice(N_TYPES, N_USERS, p=self.prior)
        n_decisions = FIRST + generator.poisson(MORE, N_USERS)
        belief = np.tile(self.prior, (N_USERS, 1))
        parts = []
        for step in range(int(n_decisions.max())):
            users = np.flatnonzero(n_decisions > step)
            rule = self.sampling(belief[users])
            probs = _mixed(rule, explore)
            policies = (
                (probs.cumsum(axis=1) < generator.random((len(users), 1))).sum(axis=1).clip(0, N_POLICIES - 1)
            )
            outcomes = (generator.random(len(users)) < self.chance[types[users], policies]).astype(np.float64)
            parts.append((users, policies, outcomes, probs[np.arange(len(users)), policies], rule))
            belief[users] = _learnt(belief[users], self._likelihood(policies, outcomes))
        columns = [np.concatenate(column) for column in zip(*parts, strict=True)]
        order = np.argsort(columns[0], kind="stable")
        return SimulatedLog(*(column[order] for column in columns))

    def value_of_rule(self, explore: float) -> float:
        """Mean outcome if belief sampling chose, after each history of `FIRST` decisions that a log has.

        Parameters
        ----------
        explore : float
            The log's; 0: belief sampling itself makes every decision.
        """
        joint, total = self.prior[None], 0.0
        for _ in range(FIRST):
            rule = self.sampling(joint / joint.sum(axis=1, keepdims=True))
            total += float(((joint @ self.chance) * rule).sum())
            joint = self._next(joint, _mixed(rule, explore))
        return total / FIRST

    def _next(self, joint: Array, probs: Array) -> Array:
        """Probability of each type and each longer history, (n · N_POLICIES · 2, N_TYPES)."""
        outcomes = np.stack([1 - self.chance, self.chance])
        longer = np.einsum("ht,hp,otp->hpot", joint, probs, outcomes).reshape(-1, N_TYPES)
        return longer[longer.sum(axis=1) > 0]

    def _likelihood(self, policies: Numbers, outcomes: Array) -> Array:
        chance = self.chance[:, policies].T
        return np.where(outcomes[:, None] > 0, chance, 1 - chance)


def _mixed(probs: Array, explore: float) -> Array:
    return (1 - explore) * probs + explore / N_POLICIES


def _learnt(belief: Array, likelihood: Array) -> Array:
    joint = belief * likelihood
    return joint / joint.sum(axis=1, keepdims=True)
