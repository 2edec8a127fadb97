"""Planning on a graph of states whose acts have uncertain results: the best acts under each type, and their value
under the other types.

    Q_i(s, a) = Σ_r P_i(r | s, a) (R_i(s, a, r) + V_i(s'(s, a, r))),    V_i(s) = max_a Q_i(s, a)

The last act gives up: it ends the episode without reward. An episode has at most `steps_left` acts.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.families.tray_graph import TrayEdges
from lifelore.agent.long_lived.task_family import Plan

Array = NDArray[np.float64]
TIE = 1e-6
"""Weight of the action prior among acts of equal value."""
SETTLED = 1e-3
"""Points by which values still change when they count as found."""


class OutcomePlanner:
    """Plans over what can be done in the states of a graph, for each type.

    Parameters
    ----------
    edges : TrayEdges
        An episode starts in state 0.
    n_acts : int
        The last act gives up and is always available.
    results, rewards : (n_types, n_edges, n_results) float64
        P(result) of what is done, and its expected reward with a result.
    tried : (n_edges,) bool
        Whether anything is known of the results.
    most : float
        No return is larger.
    steps_left : int
    new : int, optional
        The type whose untried acts are taken to be worth `most`, so that they are tried.
    preferred : (n_acts,) float, optional
        Acts of equal value: the one with the most goes first, in state 0.
    allowed : (n_acts,) bool, optional
        Acts that may be tried in state 0 although nothing is known of them.
    """

    def __init__(
        self,
        edges: TrayEdges,
        n_acts: int,
        results: Array,
        rewards: Array,
        tried: NDArray[np.bool_],
        most: float,
        steps_left: int,
        new: int | None = None,
        preferred: Array | None = None,
        allowed: NDArray[np.bool_] | None = None,
    ) -> None:
        self.edges, self.results, self.most, self.steps_left = edges, results, most, steps_left
        self.immediate = np.einsum("ker,ker->ke", results, rewards)
        self.bonus = np.zeros(n_acts) if preferred is None else TIE * preferred
        self.hopeful = np.zeros(self.immediate.shape, np.bool_)
        if new is not None:
            self.hopeful[new] = ~tried
            if allowed is not None:
                self.hopeful[new] &= allowed[edges.act] | (edges.at > 0)
        self.q = self._best_values(n_acts)

    def _best_values(self, n_acts: int) -> Array:
        """Q, (n_types, n, n_acts); minus infinity where an act is not available."""
        edges, n_types = self.edges, len(self.results)
        value, q = np.zeros((n_types, edges.n + 1)), np.full((n_types, edges.n, n_acts), -np.inf)
        q[:, :, -1] = 0.0
        for _ in range(self.steps_left):
            worth = self.immediate + np.einsum("ker,ker->ke", self.results, value[:, edges.following])
            q[:, edges.at, edges.act] = np.where(self.hopeful, self.most, worth)
            best = q.max(axis=2)
            if np.abs(best - value[:, :-1]).max(initial=0.0) < SETTLED:
                break
            value[:, :-1] = best
        return q

    def values(self) -> Array:
        """V_ij, (n_types, n_behaviours): the return of behaviour j from state 0 on in a task of type i."""
        edges, n_types = self.edges, len(self.results)
        found = np.zeros((n_types, n_types))
        if not len(edges.at):
            return found
        acts, every = self.q.argmax(axis=2), np.arange(edges.n)
        acts[:, 0] = (self.q[:, 0] + self.bonus).argmax(axis=1)
        number = np.full(self.q.shape[1:], -1)
        number[edges.at, edges.act] = np.arange(len(edges.at))
        for j in range(n_types):
            chosen = number[every, acts[j]]
            stop, ends = (chosen < 0) | self.hopeful[j, chosen], np.where(chosen < 0, 0.0, self.most)
            value = np.zeros((n_types, edges.n + 1))
            for _ in range(self.steps_left):
                after = np.einsum("ier,ier->ie", self.results[:, chosen], value[:, edges.following[chosen]])
                now = np.where(stop, ends, self.immediate[:, chosen] + after)
                if np.abs(now - value[:, :-1]).max(initial=0.0) < SETTLED:
                    break
                value[:, :-1] = now
            found[:, j] = value[:, 0]
        return found

    def plan(self) -> Plan:
        """The plan from state 0."""
        q = self.q[:, 0] + self.bonus
        return Plan(self.values(), q.argmax(axis=1), q[:, :-1].argmax(axis=1))

    def best_acts(self, states: NDArray[np.int64]) -> NDArray[np.bool_]:
        """(n, n_acts) the best acts of the first type in some of the states; equal values tie."""
        q = self.q[0, states]
        return q >= q.max(axis=1, keepdims=True) - 1e-9
