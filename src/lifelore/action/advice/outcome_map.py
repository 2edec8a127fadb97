"""`OutcomeMap`: translates between the actions of an agent and the actions of the experts, by their outcomes.

Use it to watch and advise an agent that has other actions than the experts (diagonal moves, a lift, two actions
with the same outcome): pass `common(state, action)` to `Advisor.observe`, and give the agent `own_theta(state,
theta)`. Thesis: §3.7.1.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError

NO_OUTCOME = -1


@dataclass(frozen=True, eq=False)
class OutcomeMap:
    """Maps the actions of an agent to the actions of the advisor.

    Parameters
    ----------
    outcome : (n_own,) or (n_states, n_own) int
        The advisor's action with the same outcome, in every state or for each state; -1: none. Actions without
        an outcome are no evidence and are never advised.
    n_actions : int
        Number of the advisor's actions.

    Examples
    --------
    >>> bent = OutcomeMap([1, 0, 0, -1], n_actions=2)  # the agent's second and third action both have outcome 0
    >>> bent.own_theta(0, [0.5, 0.5]).tolist()
    [0.5, 0.25, 0.25, 0.0]
    """

    outcome: ArrayLike
    n_actions: int

    def __post_init__(self) -> None:
        outcome = np.asarray(self.outcome, np.int64)
        if outcome.ndim not in (1, 2) or not outcome.size:
            raise InputError(
                f"outcome must have shape (own actions,) or (states, own actions), got {outcome.shape}"
            )
        if outcome.min() < NO_OUTCOME or outcome.max() >= self.n_actions:
            raise InputError(
                f"outcome must hold actions in [0, {self.n_actions}) or -1, got {outcome.min()}..{outcome.max()}"
            )
        object.__setattr__(self, "outcome", outcome)

    def _row(self, state: int) -> NDArray[np.int64]:
        outcome: NDArray[np.int64] = self.outcome  # type: ignore[assignment]
        return outcome if outcome.ndim == 1 else outcome[state]

    def common(self, state: int, action: int) -> int:
        """The advisor's action with the same outcome, or -1."""
        row = self._row(state)
        if not 0 <= action < len(row):
            raise InputError(f"action must be one of the agent's own in [0, {len(row)}), got {action}")
        return int(row[action])

    def own_theta(self, state: int, theta: ArrayLike) -> NDArray[np.float64]:
        """Advice over the agent's own actions, (n_own,).

        Actions with the same outcome share its probability. Outcomes that the agent cannot produce are dropped,
        and the rest is normalised to 1; all zeros if the agent can produce no advised outcome.
        """
        theta = np.asarray(theta, np.float64)
        row = self._row(state)
        usable = row != NO_OUTCOME
        sharing = np.bincount(row[usable], minlength=self.n_actions)
        own = np.zeros(len(row))
        own[usable] = theta[row[usable]] / sharing[row[usable]]
        total = own.sum()
        return own / total if total > 0 else own
