"""Reduces a domain to the states and actions that a set of tasks needs: the minimised domain.

A policy is its set of best or tied-best actions, (n_states, n_actions) bool. Rows without any action have no
policy: goals, where the episode is over, and completed configurations. There are three definitions of the pairs
(s, a) in the minimised domain:

    printed   s reachable under some policy, a optimal in s under some policy (Def. 3.2.5)
    repaired  s reachable and a optimal under one and the same policy
    closed    s reachable when every step is optimal under some policy, a optimal in s under some policy

Actions of the printed definition can lead out of the domain (errata E8). Actions of the repaired definition, the
default, cannot. Actions of the closed definition cannot either; it contains more, because it contains the policy
of every task also in states to which the policy of another task leads (errata E36). Thesis: §3.2.3, Def.
3.2.1-3.2.5, Thm 3.2.6, Props. 3.2.7-3.2.8, Alg. 3, Eq. 3.6.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import sparse

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.mdp import TERMINAL, Tables
from lifelore.core.planning.planning import checked_best, states_from

FORMS = ("repaired", "printed", "closed")

States = NDArray[np.bool_]
Pairs = NDArray[np.bool_]
Moves = tuple[NDArray[np.int32], NDArray[np.float64]]


def reachable_states(tables: Tables, best: ArrayLike) -> States:
    """States that lie on a path from S₀ under the policy, (n_states,) bool (Alg. 3).

    Parameters
    ----------
    tables : Tables
        A state entered by a TERMINAL event is reached, but its actions are not followed: the episode is over.
    best : (n_states, n_actions) bool
        The policy's actions; each of several tied actions may be taken.

    Examples
    --------
    >>> T = np.eye(3)[[[0, 1], [0, 2], [1, 2]]]  # three places in a row; actions left and right
    >>> tables = Tables.from_matrices(T, [0.0, 0.0, 1.0], terminal=2, starts=[1])
    >>> reachable_states(tables, [[False, True], [False, True], [False, False]]).tolist()
    [False, True, True]
    """
    best = _checked(tables, best)
    follow, going = tables.next_state, (tables.event & TERMINAL) == 0
    acting = states_from(
        tables.starts, tables.n_states, lambda some: follow[some][going[some] & best[some, :, None]]
    )
    acting[follow[best & acting[:, None]]] = True
    return acting


def task_futile_actions(best: ArrayLike) -> Pairs:
    """Pairs (s, a) that the task's policy does not select (Def. 3.2.1), (n_states, n_actions) bool."""
    return ~checked_best(best)


def task_futile_states(tables: Tables, best: ArrayLike) -> States:
    """States on no path from S₀ under the task's policy (Def. 3.2.2), (n_states,) bool."""
    return ~reachable_states(tables, best)


def domain_futile_actions(policies: Sequence[ArrayLike]) -> Pairs:
    """Pairs that are futile in every task (Def. 3.2.3).

    Examples
    --------
    >>> domain_futile_actions([[[False, True], [False, True]], [[False, True], [True, True]]]).tolist()
    [[True, False], [False, False]]
    """
    return np.logical_and.reduce([task_futile_actions(best) for best in policies])


def domain_futile_states(tasks: Sequence[Tables], policies: Sequence[ArrayLike]) -> States:
    """States that are futile in every task (Def. 3.2.4).

    Examples
    --------
    >>> T = np.eye(3)[[[0, 1], [0, 2], [1, 2]]]  # three places in a row; actions left and right
    >>> tables = Tables.from_matrices(T, [0.0, 0.0, 1.0], terminal=2, starts=[1])
    >>> domain_futile_states([tables], [[[False, True], [False, True], [False, False]]]).tolist()
    [True, False, False]
    """
    futile = [task_futile_states(tables, best) for tables, best in _paired(tasks, policies)[0]]
    return np.logical_and.reduce(futile)


@dataclass(frozen=True, eq=False)
class MinimisedDomain:
    """The task-set minimised domain.

    Attributes
    ----------
    form : str
        One of `FORMS`.
    states : (n_states,) bool
        Ŝ.
    pairs : (n_states, n_actions) bool
        The (s, a) with s in Ŝ and a in Â.
    kept_mass : (n_states, n_actions) float
        The probability that the outcome of a pair in `pairs` lies in Ŝ, which is 1/η; 0 for other pairs.

    Examples
    --------
    >>> T = np.eye(3)[[[0, 1], [0, 2], [1, 2]]]  # three places in a row; actions left and right
    >>> tables = Tables.from_matrices(T, [0.0, 0.0, 1.0], terminal=2, starts=[1])
    >>> minimised_domain([tables], [[[False, True], [False, True], [False, False]]]).states.tolist()
    [False, True, True]
    """

    form: str
    states: States
    pairs: Pairs
    kept_mass: NDArray[np.float64]

    @property
    def leading_out(self) -> Pairs:
        """Pairs in `pairs` with an outcome outside Ŝ; only the form "printed" has such pairs."""
        return self.pairs & (self.kept_mass < 1)

    @property
    def without_successor(self) -> Pairs:
        """Pairs in `pairs` with all outcomes outside Ŝ; their η is 1/0."""
        return self.pairs & (self.kept_mass == 0)


def minimised_domain(
    tasks: Sequence[Tables], policies: Sequence[ArrayLike], form: str = "repaired"
) -> MinimisedDomain:
    """The minimised domain of these tasks (Def. 3.2.5).

    Parameters
    ----------
    tasks : sequence of Tables
        Of one domain: the same states, actions and transitions; at least one.
    policies : sequence of (n_states, n_actions) bool
        Best or tied-best actions of each task; rows of goals and completed configurations all False.
    form : {"repaired", "printed", "closed"}
        See the module.

    Examples
    --------
    >>> T = np.eye(3)[[[0, 1], [0, 2], [1, 2]]]  # three places in a row; actions left and right
    >>> tables = Tables.from_matrices(T, [0.0, 0.0, 1.0], terminal=2)
    >>> minimised_domain([tables], [[[False, True], [False, True], [False, False]]]).pairs.tolist()
    [[False, True], [False, True], [False, False]]
    """
    if form not in FORMS:
        raise NotFoundError(f"form must be one of {', '.join(FORMS)}, got '{form}'")
    paired, moves = _paired(tasks, policies)
    reached = [reachable_states(tables, best) for tables, best in paired]
    own = [best & here[:, None] for (_, best), here in zip(paired, reached, strict=True)]
    kept = np.logical_or.reduce(own if form == "repaired" else [best for _, best in paired])
    starts = np.concatenate([tables.starts for tables in tasks])
    follow, outcome_probs = moves
    states = (
        # On a path of `kept` pairs from the starts of any task, also beyond the end of another task.
        states_from(starts, len(kept), lambda some: follow[some][kept[some]])
        if form == "closed"
        else np.logical_or.reduce(reached)
    )
    pairs = kept & states[:, None]
    inside = states[follow]
    # Exactly 1 where every outcome lies in Ŝ, because the sum of the probabilities may round to another number.
    mass = np.where(inside.all(axis=2), 1.0, np.minimum((inside * outcome_probs).sum(axis=2), 1 - 1e-16))
    return MinimisedDomain(form, states, pairs, np.where(pairs, mass, 0.0))


def minimised_transitions(tasks: Sequence[Tables], domain: MinimisedDomain) -> list[sparse.csr_array]:
    """T̂(s, a, s') = η(s, a) T(s, a, s') of Def. 3.2.5, of the domain's tasks: a square matrix for each action.

    Rows of pairs in the domain sum to 1, other rows are 0. With the form "printed" a pair all of whose outcomes
    leave Ŝ (`MinimisedDomain.without_successor`, η = 1/0) has a row of zeros, too.

    Examples
    --------
    >>> T = np.eye(3)[[[0, 1], [0, 2], [1, 2]]]  # three places in a row; actions left and right
    >>> tables = Tables.from_matrices(T, [0.0, 0.0, 1.0], terminal=2)
    >>> domain = minimised_domain([tables], [[[False, True], [False, True], [False, False]]], form="printed")
    >>> minimised_transitions([tables], domain)[1].toarray().tolist()
    [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]
    """
    follow, outcome_probs = _shared_moves(tasks)
    n_states, n_actions, n_outcomes = follow.shape
    mass = np.where(domain.pairs[:, :, None] & domain.states[follow], outcome_probs, 0.0)
    kept = mass.sum(axis=2, keepdims=True)
    mass = np.divide(mass, kept, out=np.zeros_like(mass), where=kept > 0)
    state = np.repeat(np.arange(n_states), n_outcomes)
    matrices = [
        sparse.csr_array((mass[:, a].ravel(), (state, follow[:, a].ravel())), (n_states, n_states))
        for a in range(n_actions)
    ]
    for matrix in matrices:
        matrix.eliminate_zeros()
    return matrices


def tables_within(tables: Tables, pairs: ArrayLike, dead_ends: str = "stay") -> Tables:
    """The task restricted to the given pairs: every other action acts as the first given action of its state.

    Rewards and outcomes of the given pairs do not change; probabilities are not renormalised.

    Parameters
    ----------
    tables : Tables
    pairs : (n_states, n_actions) bool
    dead_ends : {"stay", "free"}
        Actions of a state without given pairs, such as the goal of another task: every action stays there without
        reward (as in the minimised domain), or all of the state's own actions are available.
    """
    if dead_ends not in ("stay", "free"):
        raise NotFoundError(f"dead_ends must be one of stay, free, got '{dead_ends}'")
    pairs = _checked(tables, pairs)
    some = pairs.any(axis=1, keepdims=True)
    instead = np.where(pairs | ~some, np.arange(tables.n_actions), pairs.argmax(axis=1)[:, None])
    rows = np.arange(tables.n_states)[:, None]
    next_state, reward, event = (
        array[rows, instead] for array in (tables.next_state, tables.reward, tables.event)
    )
    if dead_ends == "stay":
        stuck = np.flatnonzero(~some)
        next_state[stuck], reward[stuck], event[stuck] = stuck[:, None, None], 0.0, 0
    return tables._replace(next_state=next_state, reward=reward, event=event)


def trap_states(tables: Tables, pairs: ArrayLike | None = None) -> States:
    """States from which no choice of `pairs` (default: all) ends the episode, (n_states,) bool.

    These are the trap states and dead ends of Prop. 3.2.7 for this task. States where an episode can end are none.
    """
    kept = np.ones(tables.next_state.shape[:2], bool) if pairs is None else _checked(tables, pairs)
    ends = (tables.event & TERMINAL) > 0
    over = np.zeros(tables.n_states, bool)
    over[tables.next_state[ends]] = True
    escapes = over
    while True:
        out = ends | escapes[tables.next_state]
        grown = over | (kept & out.any(axis=2)).any(axis=1)
        if np.array_equal(grown, escapes):
            return ~escapes
        escapes = grown


def futile_goal_probability(n_actions: int, n_tasks: ArrayLike, alpha0: float) -> NDArray[np.float64]:
    """Eq. 3.6: least probability of the only action that leads to a goal that was futile in all tasks so far.

    Parameters
    ----------
    n_actions : int
        At least 1.
    n_tasks : int or array of int
        |T_s| ≥ 0: number of tasks counted, each with weight 1 and with all other actions tied best. For a percept
        prior, multiply by the number of states that share the percept.
    alpha0 : float
        > 0.

    Examples
    --------
    >>> futile_goal_probability(4, [0, 10], 0.1).round(5).tolist()
    [0.25, 0.00329]
    """
    tasks = np.asarray(n_tasks, float)
    if n_actions < 1 or not (tasks >= 0).all() or not (alpha0 > 0 and np.isfinite(alpha0)):
        raise InputError(
            "n_actions must be at least 1, n_tasks at least 0 and alpha0 positive and finite, "
            f"got {n_actions}, {n_tasks} and {alpha0}"
        )
    return alpha0 / ((n_actions - 1) * (tasks + alpha0) + alpha0)


def _paired(tasks: Sequence[Tables], policies: Sequence[ArrayLike]) -> tuple[list[tuple[Tables, Pairs]], Moves]:
    """Each task with its policy, and the moves of the domain."""
    if not tasks or len(tasks) != len(policies):
        raise InputError(f"give a policy for each task, at least one, got {len(tasks)} and {len(policies)}")
    paired = [(tables, _checked(tables, best)) for tables, best in zip(tasks, policies, strict=True)]
    return paired, _shared_moves(tasks)


def _shared_moves(tasks: Sequence[Tables]) -> Moves:
    """Next states and probabilities of the tasks' domain; each state's are from the tasks that do not end there.

    Raises
    ------
    InputError
        The tasks are no list of tasks, or two have other states, actions or transitions.
    """
    if isinstance(tasks, Tables) or not tasks:
        raise InputError(f"tasks must be a list of Tables, at least one, got {type(tasks).__name__}")
    n_outcomes = max(tables.n_outcomes for tables in tasks)
    following, cumulative, acting = [], [], []
    for tables in tasks:
        unused = ((0, 0), (0, 0), (0, n_outcomes - tables.n_outcomes))
        following.append(np.pad(tables.next_state, unused, "edge"))
        cumulative.append(np.pad(tables.by_pair.outcome_cum, unused, "edge"))
        acting.append(~_ended(tables))
    known = acting[0].copy()
    for number in range(1, len(tasks)):
        if following[number].shape != following[0].shape:
            raise InputError(f"tasks must be of one domain, got task {number} with other states or actions")
        both, new = known & acting[number], acting[number] & ~known
        for shared, its in ((following[0], following[number]), (cumulative[0], cumulative[number])):
            if not np.array_equal(shared[both], its[both]):
                raise InputError(f"tasks must share their transitions (§3.2.2), got others in task {number}")
            shared[new] = its[new]
        known |= new
    return following[0], np.diff(cumulative[0], prepend=0.0)


def _ended(tables: Tables) -> NDArray[np.bool_]:
    """States that a task never leaves because they end it, (n_states,)."""
    stays = tables.next_state == np.arange(tables.n_states)[:, None, None]
    return (stays & ((tables.event & TERMINAL) != 0)).all(axis=(1, 2))


def _checked(tables: Tables, best: ArrayLike) -> Pairs:
    best = checked_best(best)
    if best.shape != (tables.n_states, tables.n_actions):
        raise InputError(f"best must have shape ({tables.n_states}, {tables.n_actions}), got {best.shape}")
    return best
