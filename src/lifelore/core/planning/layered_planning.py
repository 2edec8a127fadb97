"""Exact solutions of tasks whose states form layers without a way back.

Where items are gathered, built or used up for good (the components of a factory), the configurations form a
directed graph without cycles. Numbered so that none leads to a smaller number, each configuration is a layer of
equally many places. A layer is then a small problem whose exits have known values: one small value iteration per
layer replaces sweeps over all of them. Each iteration starts from a lower bound, so the value of a place is exact
as soon as its best path has been walked back, and the number of sweeps does not grow with 1 / (1 - γ). Layers that
cannot be reached from the requested one are not solved. Thesis: Eq. 3.1, §3.4.2.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.core.errors import InputError
from lifelore.core.mdp import TERMINAL, Tables
from lifelore.core.planning.planning import backup

LAST_MOVE = 1e-12
"""Sweeps end when no value moves by more than this share of the largest reward."""


def layered_q(tables: Tables, layer_size: int, discount: float) -> NDArray[np.float64]:
    """Optimal action values of a task in layers, (n_states, n_actions); equal to those of `planning.optimal_q`.

    Parameters
    ----------
    tables : Tables
    layer_size : int
        Places of a layer: state s lies in layer s // layer_size.
    discount : float
        γ in [0, 1).

    Raises
    ------
    InputError
        The layers do not divide the states, or a state leads to an earlier layer.
    """
    if layer_size < 1 or tables.n_states % layer_size:
        raise InputError(f"layer_size must divide the {tables.n_states} states, got {layer_size}")
    whole, n_layers = tables.by_pair, tables.n_states // layer_size

    def rows_of(layer: int) -> Tables:
        rows = slice(layer * layer_size, (layer + 1) * layer_size)
        return Tables(
            whole.next_state[rows], whole.reward[rows], whole.event[rows], whole.outcome_cum[rows], whole.starts
        )

    plan = LayeredPlan(rows_of, n_layers, layer_size, discount)
    return np.concatenate([plan.q(layer) for layer in range(n_layers)])


class LayeredPlan:
    """Exact values of a task in layers, computed on request and stored.

    Parameters
    ----------
    rows_of : callable
        ``rows_of(layer) -> Tables`` of the states of one layer; `next_state` in numbers of the whole task.
    n_layers, layer_size : int
    discount : float
        γ in [0, 1).

    Notes
    -----
    Solving a layer solves all layers that it can lead to, and no others. Values take eight bytes per state of the
    solved layers; action values are computed at each call.
    """

    def __init__(self, rows_of: Callable[[int], Tables], n_layers: int, layer_size: int, discount: float) -> None:
        self._rows_of, self.layer_size, self._discount = rows_of, layer_size, float(discount)
        # The operating system allocates pages of zeros only when they are written.
        self._value = np.zeros(n_layers * layer_size)
        self.solved = np.zeros(n_layers, np.bool_)
        """(n_layers,) bool: layers whose values are known."""

    def values(self, layer: int) -> NDArray[np.float64]:
        """Optimal values of the places of one layer, (layer_size,)."""
        self._solve(layer)
        return self._value[layer * self.layer_size : (layer + 1) * self.layer_size].copy()

    def q(self, layer: int) -> NDArray[np.float64]:
        """Optimal action values of the places of one layer, (layer_size, n_actions)."""
        self._solve(layer)
        rows = self._rows_of(layer).by_pair
        q = np.empty((self.layer_size, rows.n_actions))
        _back_up(rows, self._discount, self._value, q)
        return q

    def _solve(self, layer: int) -> None:
        if not 0 <= layer < len(self.solved):
            raise InputError(f"layer must lie in [0, {len(self.solved)}), got {layer}")
        waiting = [layer]
        while waiting:
            rows = self._rows_of(waiting[-1]).by_pair
            missing = [] if self.solved[waiting[-1]] else self._missing(rows, waiting[-1])
            if missing:
                waiting += missing
                continue
            here = waiting.pop()
            if not self.solved[here]:
                scale = LAST_MOVE * max(1.0, float(np.abs(rows.reward).max()))
                _solve_layer(rows, here * self.layer_size, self._discount, scale, self._value)
                self.solved[here] = True

    def _missing(self, rows: Tables, layer: int) -> list[int]:
        """The layers that `layer` leads to and that are not solved yet."""
        follows = _layers_after(rows, self.layer_size, np.zeros(len(self.solved), np.bool_))
        if follows.size and follows.min() < layer:
            raise _leads_back(layer)
        return [int(other) for other in follows if other != layer and not self.solved[other]]


def _leads_back(layer: int) -> InputError:
    return InputError(f"layers must only lead onwards, got a state of layer {layer} that leads to an earlier one")


@kernel
def _layers_after(rows, layer_size, seen):
    """The layers that the states of `rows` lead to, each once; `seen` is scratch."""
    found = np.empty(seen.size, np.int64)
    n = 0
    for s in range(rows.next_state.shape[0]):
        for a in range(rows.next_state.shape[1]):
            for k in range(rows.next_state.shape[2]):
                if not rows.event[s, a, k] & TERMINAL:
                    layer = rows.next_state[s, a, k] // layer_size
                    if not seen[layer]:
                        seen[layer] = True
                        found[n] = layer
                        n += 1
    return found[:n].copy()


@kernel
def _solve_layer(rows, first, discount, tolerance, value):
    """Value iteration from below over the states from `first` on; what they lead to beyond is known."""
    n_places, n_actions = rows.next_state.shape[0], rows.next_state.shape[1]
    value[first : first + n_places] = _floor(rows, first, discount, value)
    moved = tolerance + 1.0
    forwards = True
    while moved > tolerance:
        moved = 0.0
        for i in range(n_places):
            s = i if forwards else n_places - 1 - i
            best = backup(rows, s, 0, discount, value)
            for a in range(1, n_actions):
                best = max(best, backup(rows, s, a, discount, value))
            moved = max(moved, abs(best - value[first + s]))
            value[first + s] = best
        forwards = not forwards


@inlined
def _floor(rows, first, discount, value):
    """A value that no policy falls below: the worst reward for ever, the worst exit, or the end."""
    worst, lowest = 0.0, 0.0
    last = first + rows.next_state.shape[0]
    for s in range(rows.next_state.shape[0]):
        for a in range(rows.next_state.shape[1]):
            for k in range(rows.next_state.shape[2]):
                worst = min(worst, rows.reward[s, a, k])
                following = rows.next_state[s, a, k]
                if following >= last and not rows.event[s, a, k] & TERMINAL:
                    lowest = min(lowest, value[following])
    return min(lowest, worst / (1.0 - discount))


@kernel
def _back_up(rows, discount, value, q):
    """Action values from the values of all that follows, into `q`."""
    for s in range(q.shape[0]):
        for a in range(q.shape[1]):
            q[s, a] = backup(rows, s, a, discount, value)
