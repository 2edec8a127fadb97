"""Models of behaviour: what an agent of a kind would do where it is, P(A | s, M).

A model is any object with ``probs(contexts)``: contexts are (n, 2) int64, a state and the action tried last (-1
where there was none), and what comes back is (n, n_actions), rows summing to 1. The list of models is open; here
are the ones that need nothing but arrays. Thesis: §3.7.1.2, Eq. 3.14.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError


class Behaviour(Protocol):
    """What every model offers."""

    def probs(self, contexts: NDArray[np.int64], /) -> NDArray[np.float64]: ...


@dataclass(frozen=True)
class Uniform:
    """M₂ of the thesis: an agent is lost if its action seems to be drawn uniformly."""

    n_actions: int

    def probs(self, contexts: NDArray[np.int64]) -> NDArray[np.float64]:
        """1 / n_actions everywhere."""
        return np.full((len(contexts), self.n_actions), 1 / self.n_actions)


@dataclass(frozen=True, eq=False)
class Tabulated:
    """A policy written down.

    Parameters
    ----------
    table : (n_states, n_actions) or (n_states, n_actions + 1, n_actions) float
        Rows sum to 1. With three axes the middle one is the action tried last, plus 1.

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
        """The rows of the contexts."""
        table: NDArray[np.float64] = self.table  # type: ignore[assignment]
        if table.ndim == 2:
            return table[contexts[:, 0]]
        return table[contexts[:, 0], contexts[:, 1] + 1]


@dataclass(frozen=True, eq=False)
class Experts:
    """M₁ of the thesis: as the experts whose actions a prior by state has counted; uniform where none were.

    Parameters
    ----------
    prior : ActionPrior
    """

    prior: ActionPrior

    def probs(self, contexts: NDArray[np.int64]) -> NDArray[np.float64]:
        """The proportion of counts and pseudo-counts."""
        return self.prior.probs(contexts[:, 0])
