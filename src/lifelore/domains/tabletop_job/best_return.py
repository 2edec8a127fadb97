"""The best possible return of a tabletop job: best-first search over action sequences in copies of the simulator.

States in which no object differs by more than `SAME` are taken for the same: a push that moves nothing, or equal
pushes in another order, are followed once. Physics depends on the gripper and not on the user, so an `OutcomeTree`
remembers what every sequence of actions did and serves all users.
"""

import heapq
from collections.abc import Callable
from dataclasses import dataclass
from itertools import count
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.tabletop_job.events import Events
from lifelore.domains.tabletop_job.job import (
    HAND_OVER_BRISKLY,
    HAND_OVER_GENTLY,
    PICK,
    PUSH_APART,
    VERBS,
    JobState,
    TabletopJob,
    reward_of,
)
from lifelore.domains.tabletop_job.job_types import BRING, Gripper, JobType, User
from lifelore.domains.tabletop_job.skills import APPROACH, PUSH_SECONDS
from lifelore.domains.tabletop_job.tray import Tray

Actions = tuple[int, ...]
SAME = 0.002
"""Metres; of turns, the way of a point 10 cm from the object's middle."""


@dataclass(frozen=True)
class BestReturn:
    """The result of a search.

    Parameters
    ----------
    value : float
        Largest return found, points; at least 0, the return of giving up at once.
    actions : tuple of int
        A sequence that yields it.
    bound : float
        No sequence yields more; equals `value` where the search came to its end.
    simulated : int
        Actions that were carried out for this search alone.
    """

    value: float
    actions: Actions
    bound: float
    simulated: int


@dataclass(frozen=True, eq=False)
class _Node:
    state: JobState
    available: tuple[int, ...]
    events: Events | None
    bring: tuple[float, float]
    """Least seconds to bring the target from here, gently and briskly; infinite where the gripper cannot."""
    places: NDArray[np.float64]
    """Places and turns of the objects, (n_objects, 12)."""

    def same(self, other: "_Node") -> bool:
        """Whether what can be done from here is what can be done from another node."""
        ours, theirs = self.state.observation, other.state.observation
        if (ours.held, ours.gone) != (theirs.held, theirs.gone):
            return False
        here = [k for k in range(len(self.places)) if k not in ours.gone]
        return bool((np.abs(self.places[here] - other.places[here]) < SAME).all())


class OutcomeTree:
    """Outcomes of sequences of actions on a tray under a gripper; each is simulated once.

    Parameters
    ----------
    tray : Tray
    gripper : Gripper

    Examples
    --------
    A single box is brought at once:

    >>> from lifelore.domains.tabletop.layout import stand
    >>> from lifelore.domains.tabletop.shapes import box
    >>> from lifelore.domains.tabletop_job.job_types import job_type_named
    >>> from lifelore.domains.tabletop_job.tray import tray_of
    >>> tree = OutcomeTree(tray_of([stand(box(0.1, 0.06, 0.05))], 0), job_type_named("patient/firm").gripper)
    >>> tree.best(job_type_named("patient/firm").user).actions
    (0, 4)
    """

    def __init__(self, tray: Tray, gripper: Gripper) -> None:
        self.tray, self.gripper = tray, gripper
        # Outcomes do not depend on the user: any serves.
        self._job = TabletopJob(tray, JobType(User("nobody", 0.0, 0.0, 0.0), gripper))
        self.n_actions = self._job.n_actions
        self._nodes: dict[Actions, _Node] = {(): self._node(None)}
        self._seen: dict[tuple[Actions, str], Any] = {}

    def _node(self, events: Events | None) -> _Node:
        available = tuple(np.flatnonzero(self._job.available()).tolist())
        places = [np.concatenate([pose.position, 0.1 * pose.rotation.ravel()]) for pose in self._job.poses]
        return _Node(self._job.copy_state(), available, events, self._job.least_seconds(), np.array(places))

    def after(self, actions: Actions) -> _Node:
        """The node after a sequence of available actions."""
        if actions not in self._nodes:
            self._job.restore(self.after(actions[:-1]).state)
            observation, _, _ = self._job.step(actions[-1])
            self._nodes[actions] = self._node(observation.last)
        return self._nodes[actions]

    def seen(self, actions: Actions, purpose: str, look: Callable[[TabletopJob], Any]) -> Any:
        """What `look` makes of the job after a sequence of actions; computed once for each purpose."""
        if (actions, purpose) not in self._seen:
            self._job.restore(self.after(actions).state)
            self._seen[actions, purpose] = look(self._job)
        return self._seen[actions, purpose]

    def __len__(self) -> int:
        return len(self._nodes)

    def value(self, user: User, actions: Actions) -> float:
        """Return of a sequence of available actions for a user, points."""
        return sum(self._points(user, actions[:k]) for k in range(1, len(actions) + 1))

    def best(self, user: User, most: int = 5000) -> BestReturn:
        """Search until no sequence can be better, or `most` sequences were looked at."""
        before, order = len(self), count()
        best, best_actions = self._best_known(user)
        # Minus the bound, a number that breaks ties, the sequence, and the return before its last action.
        queue: list[tuple[float, int, Actions, float]] = [(-BRING, next(order), (), 0.0)]
        looked, followed = 0, list[tuple[float, _Node]]()
        while queue and -queue[0][0] > best and looked < most:
            _, _, actions, value = heapq.heappop(queue)
            node, looked = self.after(actions), looked + 1
            value += self._points(user, actions)
            if node.state.ended and value > best:
                best, best_actions = value, actions
            if any(value <= other and node.same(earlier) for other, earlier in followed):
                continue
            followed.append((value, node))
            for action in node.available:
                bound = value + self._most_from(user, node, action)
                if bound > best:
                    heapq.heappush(queue, (-bound, next(order), (*actions, action), value))
        bound = max(best, -queue[0][0]) if queue else best
        return BestReturn(float(best), best_actions, float(bound), len(self) - before)

    def _best_known(self, user: User) -> tuple[float, Actions]:
        """The best sequence to an end among those that were simulated before; giving up at once, if none is."""
        ended = [actions for actions, node in self._nodes.items() if node.state.ended]
        values = {actions: self.value(user, actions) for actions in ended}
        best = max(values, key=values.__getitem__, default=())
        if best and values[best] > 0:
            return values[best], best
        return 0.0, (self.n_actions - 1,)

    def _points(self, user: User, actions: Actions) -> float:
        """Points for the last action of a sequence."""
        events = self.after(actions).events
        if events is None:
            return 0.0
        return reward_of(user, events, actions[-1] // len(self.tray.shapes) == HAND_OVER_BRISKLY, self.tray.target)

    def _most_from(self, user: User, node: _Node, action: int) -> float:
        """No continuation that begins with an action yields more.

        It takes the least time for all that is to come, and assumes that no other object is in the way; what slips
        or is blocked costs at least the approach, and no action brings the target nearer in less time than it
        takes.
        """
        n, waiting = len(self.tray.shapes), user.waiting
        verb, number = divmod(action, n)
        if verb == len(VERBS):
            return 0.0
        bring = max(
            BRING + brisk - waiting * seconds for brisk, seconds in zip((0.0, user.brisk), node.bring, strict=True)
        )
        if verb == PICK and number == self.tray.target:
            return bring
        if verb == PUSH_APART:
            return bring - waiting * (APPROACH + PUSH_SECONDS)
        if verb in (HAND_OVER_GENTLY, HAND_OVER_BRISKLY):
            manner = user.brisk if verb == HAND_OVER_BRISKLY else 0.0
            if number == self.tray.target:
                return max(BRING + manner, bring) - waiting * APPROACH
            return bring - waiting * APPROACH + max(0.0, user.other_handed + manner)
        return bring - waiting * APPROACH
