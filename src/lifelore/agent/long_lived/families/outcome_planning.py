"""Planning on a graph of states whose acts have uncertain results: the best acts under each type, and their value
under the other types.

    Q_i(s, a) = Σ_r P_i(r | s, a) (R_i(s, a, r) + V_i(s'(s, a, r))),    V_i(s) = max_a Q_i(s, a)

The last act gives up: it ends the episode without reward. An episode has at most `steps_left` acts.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.task_family import Plan

Array = NDArray[np.float64]
TIE = 1e-6
"""Weight of the action prior among acts of equal value."""
SETTLED = 1e-3
"""Points by which values still change when they count as found."""


@dataclass(frozen=True, eq=False)
class OutcomeModel:
    """A decision process over n states for each type; an episode starts in state 0.

    Parameters
    ----------
    available : (n, n_acts) bool
        The last act gives up and is always available.
    results : (n_types, n, n_acts - 1, n_results) float64
        P(result | state, act).
    rewards : (n_types, n, n_acts - 1, n_results) float64
        Expected reward of an act with a result.
    following : (n, n_acts - 1, n_results) int64
        The state after each result; n is the end.
    tried : (n, n_acts - 1) bool
        Whether anything is known of the results of an act.
    most : float
        No return is larger.
    steps_left : int
    """

    available: NDArray[np.bool_]
    results: Array
    rewards: Array
    following: NDArray[np.int64]
    tried: NDArray[np.bool_]
    most: float
    steps_left: int


class OutcomePlanner:
    """Plans of a model.

    Parameters
    ----------
    model : OutcomeModel
    new : int, optional
        The type whose untried acts are taken to be worth `most`, so that they are tried.
    preferred : (n_acts,) float, optional
        Acts of equal value: the one with the most goes first, in state 0.
    allowed : (n_acts,) bool, optional
        Acts that may be tried in state 0 although nothing is known of them.
    """

    def __init__(
        self,
        model: OutcomeModel,
        new: int | None = None,
        preferred: Array | None = None,
        allowed: NDArray[np.bool_] | None = None,
    ) -> None:
        self.model = model
        n_types, n, n_acts, _ = model.results.shape
        self._immediate = np.einsum("kfar,kfar->kfa", model.results, model.rewards)
        self._bonus = np.zeros(n_acts + 1) if preferred is None else TIE * preferred
        self._hopeful = np.zeros((n_types, n, n_acts), np.bool_)
        if new is not None:
            self._hopeful[new] = ~model.tried & model.available[:, :-1]
            if allowed is not None:
                self._hopeful[new, 0] &= allowed[:-1]
        self.q = self._best_values()

    def _best_values(self) -> Array:
        """Q, (n_types, n, n_acts); minus infinity where an act is not available."""
        model = self.model
        n_types, n, n_acts, _ = model.results.shape
        value, q = np.zeros((n_types, n + 1)), np.zeros((n_types, n, n_acts + 1))
        for _ in range(model.steps_left):
            q[:, :, :-1] = self._immediate + np.einsum("kfar,kfar->kfa", model.results, value[:, model.following])
            q[:, :, :-1][self._hopeful] = model.most
            q[:, ~model.available] = -np.inf
            best = q.max(axis=2)
            if np.abs(best - value[:, :-1]).max(initial=0.0) < SETTLED:
                break
            value[:, :-1] = best
        return q

    def values(self) -> Array:
        """V_ij, (n_types, n_behaviours): the return of behaviour j from state 0 on in a task of type i."""
        model = self.model
        n_types, n, n_acts, _ = model.results.shape
        acts, every = self.q.argmax(axis=2), np.arange(n)
        acts[:, 0] = (self.q[:, 0] + self._bonus).argmax(axis=1)
        gives_up = acts == n_acts
        chosen = np.where(gives_up, 0, acts)
        stop = gives_up | self._hopeful[np.arange(n_types)[:, None], every, chosen]
        ends = np.where(gives_up, 0.0, model.most)
        found = np.empty((n_types, n_types))
        for j in range(n_types):
            results = model.results[:, every, chosen[j]]
            immediate, following = self._immediate[:, every, chosen[j]], model.following[every, chosen[j]]
            value = np.zeros((n_types, n + 1))
            for _ in range(model.steps_left):
                now = immediate + np.einsum("ifr,ifr->if", results, value[:, following])
                now = np.where(stop[j], ends[j], now)
                if np.abs(now - value[:, :-1]).max(initial=0.0) < SETTLED:
                    break
                value[:, :-1] = now
            found[:, j] = value[:, 0]
        return found

    def plan(self) -> Plan:
        """The plan from state 0."""
        q = self.q[:, 0] + self._bonus
        return Plan(self.values(), q.argmax(axis=1), q[:, :-1].argmax(axis=1))

    def best_acts(self, states: NDArray[np.int64]) -> NDArray[np.bool_]:
        """(n, n_acts) the best acts of the first type in some of the states; equal values tie."""
        q = self.q[0, states]
        return q >= q.max(axis=1, keepdims=True) - 1e-9
