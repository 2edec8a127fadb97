"""Domains, tasks and their tables: ``D = (S, A, T, γ)``, ``τ = (D, R, S₀)`` (thesis §3.2.2).

A domain is one pure scalar function ``step(params, s, a, u) -> (s2, reward, event)``. From it come the
tables that every kernel and the exact solver read, and the Gymnasium environment. `u` is one uniform in
[0, 1); a deterministic domain ignores it. `event` holds the bits `TERMINAL` and `COLLISION`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError

NOTHING, TERMINAL, COLLISION = 0, 1, 2
"""Events: none; the episode ends; the world refused the move, for instance by a wall. The last two are bits."""

Step = Callable[[tuple, int, int, float], tuple[int, float, int]]


class Tables(NamedTuple):
    """All transitions of a task as arrays, which kernels, the exact solver and checks read.

    Tables made by hand are checked where planning and learning begin, see `checked`.

    Parameters
    ----------
    next_state : (n_states, n_actions, n_outcomes) int32
    reward : (n_states, n_actions, n_outcomes) float64
    event : (n_states, n_actions, n_outcomes) uint8
        Bits ``TERMINAL`` (1: the episode ends) and ``COLLISION`` (2: the world refused the move).
    outcome_cum : (n_outcomes,) or (n_states, n_actions, n_outcomes) float64
        Cumulative probabilities of the outcomes; the last is 1. One row may serve all states and actions.
    starts : (n_starts,) int32
        An episode starts in one of these states, drawn uniformly.

    Examples
    --------
    >>> T = np.eye(3)[[[0, 1], [0, 2], [1, 2]]]  # three places in a row; actions left and right
    >>> tables = Tables.from_matrices(T, [0.0, 0.0, 1.0], terminal=2)
    >>> tables.n_states, tables.n_actions
    (3, 2)
    """

    next_state: NDArray[np.int32]
    reward: NDArray[np.float64]
    event: NDArray[np.uint8]
    outcome_cum: NDArray[np.float64]
    starts: NDArray[np.int32]

    @property
    def n_states(self) -> int:
        """Number of states."""
        return self.next_state.shape[0]

    @property
    def n_actions(self) -> int:
        """Number of actions."""
        return self.next_state.shape[1]

    @property
    def n_outcomes(self) -> int:
        """Number of outcomes of a move; 1 where the task is deterministic."""
        return self.outcome_cum.shape[-1]

    @property
    def by_pair(self) -> "Tables":
        """The same task with ``outcome_cum`` by state and action, without a copy."""
        return self._replace(outcome_cum=np.broadcast_to(self.outcome_cum, self.next_state.shape))

    def checked(self) -> "Tables":
        """The same tables; InputError where kernels would read foreign memory, or answer with wrong numbers."""
        states, cumulative = np.r_[self.next_state.ravel(), self.starts], self.outcome_cum
        if states.dtype.kind not in "iu" or not ((states >= 0) & (states < self.n_states)).all():
            raise InputError(f"next_state and starts must be whole numbers from 0 to {self.n_states - 1}")
        shape = self.next_state.shape
        if not (shape == self.reward.shape == self.event.shape and np.isfinite(self.reward).all()):
            raise InputError(f"reward and event must be of shape {shape}, rewards finite")
        rises = (np.diff(cumulative, axis=-1, prepend=0.0) >= -1e-12).all()
        if not (rises and (np.abs(cumulative[..., -1] - 1) <= 1e-9).all()):
            raise InputError("outcome_cum must rise to 1: it holds cumulative probabilities of the outcomes")
        return self

    @classmethod
    def from_matrices(
        cls, transitions: Any, rewards: Any = None, terminal: ArrayLike = (), starts: Any = None
    ) -> "Tables":
        """The tables of an MDP that is given as T(s, a, s') and R.

        Memory and time grow with n_states · n_actions · the largest number of next states of a move.

        Parameters
        ----------
        transitions : (n_states, n_actions, n_states) float; list of sparse matrices; or dictionaries
            Probabilities T(s, a, s'). Sparse: one (n_states, n_states) matrix an action. Dictionaries:
            ``{state: {action: {next state: probability}}}``, all numbered from 0.
        rewards : (n_states, n_actions, n_states), (n_states, n_actions) or (n_states,) float
            Reward of a move, of an action in a state, or of entering a state. Sparse matrices and dictionaries in
            the forms of `transitions` are rewards of moves, 0 where they have no entry. Leave them out where
            `transitions` is ``env.unwrapped.P`` of one of Gymnasium's toy worlds, which holds rewards and ends.
        terminal : (n,) int or (n_states,) bool
            States that end the episode when they are entered; their own rows are not read.
        starts : (n_starts,) int or (n_states,) bool, optional
            By default every state that is not terminal.

        Raises
        ------
        InputError
            A shape is wrong; a row of probabilities does not sum to 1 to 1e-9; a reward that is read is not
            finite; a start is terminal, or there is none.

        Examples
        --------
        >>> tables = Tables.from_matrices([[[0.5, 0.5], [1, 0]], [[0, 0], [0, 0]]], [0, 10.0], terminal=[1])
        >>> tables.next_state[0].tolist(), tables.reward[0].tolist(), tables.outcome_cum[0].tolist()
        ([[0, 1], [0, 0]], [[0.0, 10.0], [0.0, 0.0]], [[0.5, 1.0], [1.0, 1.0]])
        """
        from lifelore.core.matrices import checked_numbers, outcomes_of, outcomes_of_moves

        if rewards is None:
            outcomes, ends = outcomes_of_moves(transitions)
            ends |= np.isin(outcomes.following, checked_numbers(terminal, len(ends), "terminal"))
            ended = np.isin(np.arange(len(ends)), outcomes.following[ends])
        else:
            outcomes, ended = outcomes_of(transitions, rewards, terminal)
            ends = ended[outcomes.following]
        begin = np.flatnonzero(~ended) if starts is None else checked_numbers(starts, len(ended), "starts")
        if not begin.size or ended[begin].any():
            raise InputError(
                f"starts must name at least one state, none of them terminal, got {begin[ended[begin]].tolist()} "
                "that are terminal"
                if begin.size
                else "starts must name at least one state, got none"
            )
        event = np.where(ends, TERMINAL, NOTHING).astype(np.uint8)
        return cls(outcomes.following, outcomes.reward, event, outcomes.cumulative, begin.astype(np.int32))


@dataclass(frozen=True)
class Domain:
    """The part that tasks share: states, actions, transitions, discount.

    Parameters
    ----------
    name : str
    n_states, n_actions : int
        Both at least 1.
    step : callable
        Pure ``step(params, s, a, u) -> (s2, reward, event)`` on scalars; plain Python or a kernel.
    discount : float
        γ in [0, 1).
    outcome_probs : sequence of float
        Lengths of the intervals of ``u`` on which `step` is constant; they sum to 1. ``(1.0,)``
        where the domain is deterministic.
    tabulate : callable, optional
        ``tabulate(params, midpoints) -> (next_state, reward, event)``: the same table from a compiled
        loop. Must equal the table enumerated through `step`, the default.

    Thesis: §3.2.2.

    Examples
    --------
    >>> walk = lambda params, s, a, u: (min(s + a, 3), float(s + a >= 3), TERMINAL if s + a >= 3 else NOTHING)
    >>> Domain("walk", 4, 2, walk, discount=0.9).step((), 2, 1, 0.5)
    (3, 1.0, 1)
    """

    name: str
    n_states: int
    n_actions: int
    step: Step
    discount: float
    outcome_probs: Sequence[float] = (1.0,)
    tabulate: Callable | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        if self.n_states < 1 or self.n_actions < 1:
            raise InputError(
                f"n_states and n_actions must be at least 1, got {self.n_states} and {self.n_actions}"
            )
        if not 0.0 <= self.discount < 1.0:
            raise InputError(f"discount must lie in [0, 1), got {self.discount}")
        probs = np.asarray(self.outcome_probs, float)
        if not ((probs > 0).all() and abs(probs.sum() - 1) <= 1e-12):
            raise InputError(f"outcome_probs must be positive and sum to 1, got {list(self.outcome_probs)}")


@dataclass(frozen=True)
class Task:
    """A domain with its reward and initial states.

    Parameters
    ----------
    domain : Domain
    params : tuple
        Arrays and numbers passed to `Domain.step`; tasks of one domain differ in these alone.
    starts : (n_starts,) int
        Initial states S₀, drawn uniformly.
    goal : int, optional
        The goal state, where the task has one.

    Examples
    --------
    >>> walk = lambda params, s, a, u: (min(s + a, 3), float(s + a >= 3), TERMINAL if s + a >= 3 else NOTHING)
    >>> task = Task(Domain("walk", 4, 2, walk, discount=0.9), params=(), starts=np.arange(3), goal=3)
    >>> task.tables().n_states
    4
    """

    domain: Domain
    params: tuple
    starts: NDArray[np.int32]
    goal: int | None = None

    def __post_init__(self) -> None:
        starts, n_states = np.asarray(self.starts), self.domain.n_states
        if starts.dtype.kind not in "iu" or not starts.size or starts.min() < 0 or starts.max() >= n_states:
            raise InputError(
                f"starts must name at least one state, numbers from 0 to {n_states - 1}, got {starts}"
            )

    def tables(self) -> Tables:
        """Enumerate the task into `Tables`; InputError where a step leaves the domain or pays no number."""
        domain = self.domain
        cum = np.cumsum(np.asarray(domain.outcome_probs, dtype=np.float64))
        cum[-1] = 1.0
        midpoints = cum - np.asarray(domain.outcome_probs) / 2
        enumerate_all = domain.tabulate or _enumerate_with(domain)
        next_state, reward, event = enumerate_all(self.params, midpoints)
        # A state out of range would read foreign memory inside the kernels.
        if next_state.min() < 0 or next_state.max() >= domain.n_states or not np.isfinite(reward).all():
            raise InputError(
                f"step of domain '{domain.name}' must lead to states from 0 to {domain.n_states - 1} with finite "
                f"rewards, from a goal too; it leads to {next_state.min()} to {next_state.max()}"
            )
        return Tables(next_state, reward, event, cum, np.ascontiguousarray(self.starts, dtype=np.int32))


def _enumerate_with(domain: Domain) -> Callable:
    """Enumerate by calling `step`; `Domain.tabulate` replaces this where it would be slow."""
    step = getattr(domain.step, "py_func", domain.step)

    def enumerate_all(params: tuple, midpoints: NDArray[np.float64]):
        shape = (domain.n_states, domain.n_actions, len(midpoints))
        next_state, reward = np.empty(shape, np.int32), np.empty(shape, np.float64)
        event = np.empty(shape, np.uint8)
        for index in np.ndindex(shape):
            s, a, k = index
            next_state[index], reward[index], event[index] = step(params, s, a, float(midpoints[k]))
        return next_state, reward, event

    return enumerate_all
