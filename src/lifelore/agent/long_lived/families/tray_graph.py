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
UNKNOWN = -1


class Answer(NamedTuple):
    """What an act resulted in."""

    result: int
    reward: float
    ended: bool


class TrayEdges(NamedTuple):
    """What can be done in the states of a tray, the present state first.

    n : number of states; n itself is the end
    at, act, cause : (n_edges,) int64, of everything but giving up
    payments, following : (n_edges, n_results) int64, by result: what the user pays for, and the next state
    answer : (n_edges,) int64, the result, where it is known or expected from the same scene; else `UNKNOWN`
    paid : (n_edges,) float64, the reward of a known answer
    lived : the states that were lived, by number
    """

    n: int
    at: NDArray[np.int64]
    act: NDArray[np.int64]
    cause: NDArray[np.int64]
    payments: NDArray[np.int64]
    following: NDArray[np.int64]
    answer: NDArray[np.int64]
    paid: NDArray[np.float64]
    lived: dict[int, TrayState]


@dataclass(eq=False)
class TrayGraph:
    """The states of one task."""

    states: dict[Done, TrayState] = field(default_factory=dict)
    answers: dict[Done, Answer] = field(default_factory=dict)
    _alike: dict[Done, Done] = field(default_factory=dict)
    _ways: dict[TrayState, list[tuple]] = field(default_factory=dict)
    _made: dict[Done, TrayEdges] = field(default_factory=dict)

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

    def ways(self, state: TrayState) -> list[tuple[int, int, int, list[int], list[TrayState | None]]]:
        """What can be done in a state: act, object, cause, and by result what is paid for and the next state."""
        if state not in self._ways:
            picks_left = len(state.failed) < MOST_FAILED
            self._ways[state] = [
                (act, number, state.cause(act, number), state.payments(act), state.after(act, number))
                for act, number in state.named().items()
                if picks_left or state.held is not None
            ]
        return self._ways[state]

    def edges(self, done: Done) -> TrayEdges:
        """What can be done from the state after some actions on; that one was seen."""
        if done not in self._made:
            self._made[done] = self._edges(done)
        return self._made[done]

    def _edges(self, done: Done) -> TrayEdges:
        number_of: dict[Node, int] = {(done, self.states[done]): 0}
        order = list(number_of)

        def place(node: Node) -> int:
            if node not in number_of:
                number_of[node] = len(order)
                order.append(node)
            return number_of[node]

        rows = []
        for at, (lived, state) in enumerate(order):  # grows while it is read
            for act, number, cause, payments, after in self.ways(state):
                known = None if lived is None else self._answer((*lived, (VERB[act], number)))
                if known is None:
                    following = [-1 if one is None else place((None, one)) for one in after]
                    rows.append((at, act, cause, payments, following, UNKNOWN, 0.0))
                else:
                    then, answer = known
                    following = [-1 if answer.ended else place((then, self.states[then]))] * len(RESULTS)
                    rows.append((at, act, cause, payments, following, answer.result, answer.reward))
        n, columns = len(rows), zip(*rows, strict=True) if rows else [[]] * 7
        at, act, cause, payments, following, answers, paid = (np.array(one) for one in columns)
        payments, following = (one.reshape(n, len(RESULTS)).astype(np.int64) for one in (payments, following))
        following[following < 0] = len(order)
        states = {number: state for number, (lived, state) in enumerate(order) if lived is not None}
        at, act, cause, answers = (one.astype(np.int64) for one in (at, act, cause, answers))
        return TrayEdges(len(order), at, act, cause, payments, following, answers, paid, states)
