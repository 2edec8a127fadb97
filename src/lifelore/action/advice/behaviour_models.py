"""Models of behaviour: the action probabilities P(A | s, M) of experts and of other agents.

A model is any object with ``probs(contexts)``. `contexts` is (n, 2) int64: a state, and the last action or -1. The
result is (n, n_actions) with rows that sum to 1. You can add models; these need only arrays.
Thesis: §3.7.1.2, Eq. 3.14.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError


class Behaviour(Protocol):
    """The method of every model."""

    def probs(self, contexts: NDArray[np.int64], /) -> NDArray[np.float64]: ...


@dataclass(frozen=True)
class Uniform:
    """M₂ of the thesis: a lost agent, which draws its actions uniformly."""

    n_actions: int

    def probs(self, contexts: NDArray[np.int64]) -> NDArray[np.float64]:
        """1 / n_actions everywhere."""
        return np.full((len(contexts), self.n_actions), 1 / self.n_actions)


@dataclass(frozen=True, eq=False)
class Tabulated:
    """A policy given as a table.

    Parameters
    ----------
    table : (n_states, n_actions) or (n_states, n_actions + 1, n_actions) float
        Rows sum to 1. With three axes the middle one is the last action plus 1.

    Examples
    --------
    >>> Tabulated([[0.0, 1.0], [0.5, 0.5]]).probs(np.array([[1, -1], [0, 1]])).tolist()
    [[0.5, 0.5], [0.0, 1.0]]
    """

    table: ArrayLike

    def __post_init__(self) -> None:
        table = np.asarray(self.table, np.float64)
        last = table.shape[-1]
        if table.ndim not in (2, 3) or (table.ndim == 3 and table.shape[1] != last + 1):
            raise InputError(
                f"table must have shape (states, actions) or (states, actions + 1, actions), got {table.shape}"
            )
        if (table < 0).any() or not np.allclose(table.sum(axis=-1), 1, atol=1e-9):
            raise InputError("table must hold probabilities: non-negative rows that sum to 1")
        object.__setattr__(self, "table", table)

    def probs(self, contexts: NDArray[np.int64]) -> NDArray[np.float64]:
        """Rows of the table for the contexts."""
        table: NDArray[np.float64] = self.table  # type: ignore[assignment]
        if table.ndim == 2:
            return table[contexts[:, 0]]
        return table[contexts[:, 0], contexts[:, 1] + 1]


@dataclass(frozen=True, eq=False)
class Experts:
    """M₁ of the thesis: experts whose actions a state prior has counted; uniform in states without counts.

    Parameters
    ----------
    prior : ActionPrior
    """

    prior: ActionPrior

    def probs(self, contexts: NDArray[np.int64]) -> NDArray[np.float64]:
        """The proportion of counts and pseudo-counts."""
        return self.prior.probs(contexts[:, 0])
