"""The states that an episode can go through on a tray, as arrays for plans: what was lived, and what is foreseen.

The same scene answers the same act alike: where an episode of this task has taken an act after the same acts, its
answer is known. Acts in vain have left the scene about as it was: what came after them is expected without them,
too, so that the next episode leaves them out. Beyond what was lived, states are foreseen by `tray_states`.
"""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.families.tray_states import (
    ACTS,
    GIVE_UP,
    IN_VAIN,
    MOST_FAILED,
    RESULTS,
    SPILLS,
    VERB,
    TrayState,
)
from lifelore.domains.tabletop_job.job import PUSH_APART

Done = tuple[tuple[int, int], ...]
"""Verbs and objects of the actions of an episode."""
Node = tuple[Done | None, TrayState]
HARMLESS = frozenset(IN_VAIN) - frozenset(SPILLS)
"""Results that leave a scene about as it was."""
_Row = tuple[int, int, int, list[int], list[int]]
"""State, act, cause, and by result what it is paid for and the state that follows."""


class Answer(NamedTuple):
    """What an act resulted in."""

    result: int
    reward: float
    ended: bool


@dataclass(frozen=True, eq=False)
class TrayNodes:
    """States as arrays, the present one first; n is the end.

    Parameters
    ----------
    available : (n, n_acts) bool
    causes : (n, n_acts - 1) int64
        0 where an act is not available.
    payments, following : (n, n_acts - 1, n_results) int64
    answered : (n, n_acts - 1) bool
        Whether an act's answer is known, or expected from the same scene.
    answers, paid : (n_answered, n_results) and (n_answered,) float64
        The known results, of probability 1, and their rewards.
    lived : dict of int to TrayState
        The states that were lived, by number.
    """

    available: NDArray[np.bool_]
    causes: NDArray[np.int64]
    payments: NDArray[np.int64]
    following: NDArray[np.int64]
    answered: NDArray[np.bool_]
    answers: NDArray[np.float64]
    paid: NDArray[np.float64]
    lived: dict[int, TrayState]


class _Way(NamedTuple):
    """An act in a state: its cause, and by result what it is paid for and the states that follow."""

    act: int
    number: int
    cause: int
    payments: list[int]
    after: list[TrayState | None]


@dataclass(eq=False)
class TrayGraph:
    """The states of one task."""

    states: dict[Done, TrayState] = field(default_factory=dict)
    answers: dict[Done, Answer] = field(default_factory=dict)
    _alike: dict[Done, Done] = field(default_factory=dict)
    _ways: dict[TrayState, list[_Way]] = field(default_factory=dict)
    _made: dict[Done, TrayNodes] = field(default_factory=dict)

    def saw(self, done: Done, state: TrayState) -> None:
        """After some actions, this is the state."""
        if done not in self.states:
            self.states[done] = state
            self._made.clear()

    def answered(self, done: Done, answer: Answer) -> None:
        """The last of some actions had this answer."""
        if done not in self.answers:
            self.answers[done] = answer
            self._alike[self._without_vain(done)] = done
            self._made.clear()

    def _without_vain(self, done: Done) -> Done:
        """Actions without those before the last that were in vain and spilled nothing.

        A push that made no room may have moved its object: it counts where the last action is a push, too.
        """
        verb = done[-1][0]
        before = [
            action
            for k, action in enumerate(done[:-1])
            if self.answers[done[: k + 1]].result not in HARMLESS or action[0] == verb == PUSH_APART
        ]
        return (*before, done[-1])

    def _answer(self, done: Done) -> tuple[Done, Answer] | None:
        """The answer to the last of some actions, and the actions after which it was lived; None if unknown."""
        lived = done if done in self.answers else self._alike.get(self._without_vain(done))
        return None if lived is None else (lived, self.answers[lived])

    def ways(self, state: TrayState) -> list[_Way]:
        """What can be done in a state, but giving up."""
        if state not in self._ways:
            picks_left = len(state.failed) < MOST_FAILED
            self._ways[state] = [
                _Way(act, number, state.cause(act, number), state.payments(act), state.after(act, number))
                for act, number in state.named().items()
                if picks_left or state.held is not None
            ]
        return self._ways[state]

    def nodes(self, done: Done) -> TrayNodes:
        """The states from the one after some actions on; that one was seen."""
        if done not in self._made:
            self._made[done] = self._nodes(done)
        return self._made[done]

    def _nodes(self, done: Done) -> TrayNodes:
        first: Node = done, self.states[done]
        number_of: dict[Node, int] = {first: 0}
        order: list[Node] = [first]

        def place(node: Node) -> int:
            if node not in number_of:
                number_of[node] = len(order)
                order.append(node)
            return number_of[node]

        rows: list[_Row] = []
        known: list[tuple[int, int, Answer]] = []
        for at, (lived, state) in enumerate(order):  # grows while it is read
            for way in self.ways(state):
                known_answer = None if lived is None else self._answer((*lived, (VERB[way.act], way.number)))
                if known_answer is not None:
                    then, answer = known_answer
                    known.append((at, way.act, answer))
                    after = -1 if answer.ended else place((then, self.states[then]))
                    following = [after] * len(RESULTS)
                else:
                    following = [-1 if after is None else place((None, after)) for after in way.after]
                rows.append((at, way.act, way.cause, way.payments, following))
        states = {place: state for place, (lived, state) in enumerate(order) if lived is not None}
        return _as_arrays(len(order), rows, known, states)


def _as_arrays(
    n: int,
    rows: list[_Row],
    known: list[tuple[int, int, Answer]],
    lived: dict[int, TrayState],
) -> TrayNodes:
    available = np.zeros((n, len(ACTS)), np.bool_)
    available[:, GIVE_UP] = True
    causes, payments = np.zeros((n, GIVE_UP), np.int64), np.zeros((n, GIVE_UP, len(RESULTS)), np.int64)
    following = np.full((n, GIVE_UP, len(RESULTS)), n)
    if rows:
        at, act, cause, paid_for, after = (np.array(column) for column in zip(*rows, strict=True))
        available[at, act], causes[at, act], payments[at, act] = True, cause, paid_for
        following[at, act] = np.where(after < 0, n, after)
    answered = np.zeros((n, GIVE_UP), np.bool_)
    answers, paid = np.zeros((n, GIVE_UP, len(RESULTS))), np.zeros((n, GIVE_UP))
    for place, act, answer in known:
        answered[place, act] = True
        answers[place, act, answer.result], paid[place, act] = 1, answer.reward
    return TrayNodes(available, causes, payments, following, answered, answers[answered], paid[answered], lived)
