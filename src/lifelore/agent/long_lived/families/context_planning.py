"""Planning over contexts: the best acts under each type, and their value under the other types.

    Q_i(c, a) = Σ_r P_i(r | c, a) (R_i(c, a, r) + Σ_c' P(c' | c, a, r) V_i(c')),    V_i(c) = max_a Q_i(c, a)

The last act gives up: it ends the episode without reward. An episode has at most `steps_left` acts.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.long_lived.task_family import Plan

Array = NDArray[np.float64]
TIE = 1e-6
"""Weight of the action prior among acts of equal value."""
ALLOWED = 0.05
"""Share of the counts of a context from which an act counts as sensible there."""


@dataclass(frozen=True, eq=False)
class ContextModel:
    """A decision process over contexts for each type.

    Parameters
    ----------
    contexts : (n,) int64
        Codes, ascending.
    available : (n, n_acts) bool
    results : (n_types, n, n_acts - 1, n_results) float64
        P(result | context, act).
    rewards : (n_types, n, n_acts - 1, n_results) float64
        Expected reward of an act with a result in a context.
    moves : (n, n_acts - 1, n_results, n + 1) float64
        P(next context | context, act, result); the last column is the end.
    tried : (n, n_acts - 1) bool
        Whether anything is known of the results of an act.
    most : float
        No return is larger.
    steps_left : int
    """

    contexts: NDArray[np.int64]
    available: NDArray[np.bool_]
    results: Array
    rewards: Array
    moves: Array
    tried: NDArray[np.bool_]
    most: float
    steps_left: int


class ContextPlanner:
    """Plans of a model.

    Parameters
    ----------
    model : ContextModel
    new : int, optional
        The type whose untried acts are taken to be worth `most`, so that they are tried; of these only acts that
        the action prior finds sensible, where it knows the context.
    acts : ActionPrior, optional
    """

    def __init__(self, model: ContextModel, new: int | None, acts: ActionPrior | None) -> None:
        self.model = model
        n_types, n, n_acts, _ = model.results.shape
        self._immediate = np.einsum("kfar,kfar->kfa", model.results, model.rewards)
        self._next = np.einsum("kfar,farg->kfag", model.results, model.moves)
        self._bonus = np.zeros((n_types, n, n_acts + 1))
        allowed = np.ones((n, n_acts + 1), np.bool_)
        if acts is not None and len(acts):
            self._bonus += TIE * acts.probs(model.contexts)
            allowed = acts.mask(model.contexts, ALLOWED)
        self._hopeful = np.zeros((n_types, n, n_acts), np.bool_)
        if new is not None:
            self._hopeful[new] = ~model.tried & allowed[:, :-1] & model.available[:, :-1]
        self.q = self._best_values()

    def _best_values(self) -> Array:
        """Q, (n_types, n, n_acts); minus infinity where an act is not available."""
        model = self.model
        n_types, n, n_acts, _ = model.results.shape
        value = np.zeros((n_types, n + 1))
        q = np.zeros((n_types, n, n_acts + 1))
        for _ in range(model.steps_left):
            q[:, :, :-1] = self._immediate + np.einsum("kfag,kg->kfa", self._next, value, optimize=True)
            q[:, :, :-1][self._hopeful] = model.most
            q[:, ~model.available] = -np.inf
            best = q.max(axis=2)
            if np.abs(best - value[:, :-1]).max(initial=0.0) < 1e-3:
                break
            value[:, :-1] = best
        return q

    @property
    def policies(self) -> NDArray[np.int64]:
        """The act of each type's behaviour in each context, (n_types, n)."""
        return (self.q + self._bonus).argmax(axis=2)

    def values(self) -> Array:
        """V_ij, (n_types, n_behaviours, n): the return of behaviour j in a task of type i."""
        model, acts = self.model, self.policies
        n_types, n = acts.shape
        every = np.arange(n)
        gives_up = acts == model.results.shape[2]
        chosen = np.where(gives_up, 0, acts)
        stop = gives_up | self._hopeful[np.arange(n_types)[:, None], every, chosen]
        immediate = self._immediate[:, every, chosen]
        following = self._next[:, every, chosen]
        ends = np.where(gives_up, 0.0, model.most)
        value = np.zeros((n_types, n_types, n + 1))
        for _ in range(model.steps_left):
            found = immediate + np.einsum("ijfg,ijg->ijf", following, value, optimize=True)
            found = np.where(stop, ends, found)
            if np.abs(found - value[:, :, :-1]).max(initial=0.0) < 1e-3:
                break
            value[:, :, :-1] = found
        return value[:, :, :-1]

    def plan(self, context: int) -> Plan:
        """The plan from a context."""
        place = int(np.searchsorted(self.model.contexts, context))
        trying = (self.q + self._bonus)[:, place, :-1].argmax(axis=1)
        return Plan(self.values()[:, :, place], self.policies[:, place], trying)

    def best_acts(self, contexts: NDArray[np.int64]) -> NDArray[np.bool_]:
        """(n, n_acts) the best acts of the first type in some of the contexts; equal values tie."""
        q = self.q[0, np.searchsorted(self.model.contexts, contexts)]
        return q >= q.max(axis=1, keepdims=True) - 1e-9
