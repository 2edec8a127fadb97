"""Tabletop jobs as the long-lived agent meets them: acts and causes in words of the perceived tray.

Two kinds of causes have effects that depend on the hidden type:

- an act in a situation: it is done, or it misses, slips, knocks or spills (the gripper). The situation is that of
  the object which the act is about, so that all objects of all trays teach one model;
- what happened, whichever act has led to it: the reward, in bins (the user). An object that is spilled costs the
  user's points, be it by a pick or by a push.

What an act leads to is foreseen from the perceived scene (`tray_states`). What this very tray has answered before,
in an earlier episode of the task, is remembered act by act.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.families.outcome_planning import OutcomePlanner
from lifelore.agent.long_lived.families.tray_features import (
    PerceivedTray,
    look_at_raw_cloud,
)
from lifelore.agent.long_lived.families.tray_graph import UNKNOWN, Answer, Done, TrayGraph
from lifelore.agent.long_lived.families.tray_states import (
    ACTS,
    KNOCK,
    LOAD_NAMES,
    N_SITUATED,
    QUIET,
    RESULTS,
    ROOM_NAMES,
    SPILL,
    VERB,
    TrayState,
    result_of,
)
from lifelore.agent.long_lived.task_family import Plan, SharedKnowledge, Step
from lifelore.domains.tabletop_job.events import Events
from lifelore.domains.tabletop_job.job import LONGEST, TabletopJob
from lifelore.domains.tabletop_job.job_replay import JobReplay
from lifelore.domains.tabletop_job.job_types import BRING

Array = NDArray[np.float64]

HANDS = ("nothing", "the target", "another object")
N_ACTS, N_RESULTS = len(ACTS), len(RESULTS)
ALLOWED = 0.05
"""Share of the counts of a context from which an act counts as sensible there."""
USUAL_SECONDS = 4.0
"""Seconds of an act, about: what waiting costs is counted for so long."""
BIN = 0.5
"""Width of a bin of rewards, points."""
LOWEST, N_BINS = -10.0, 43


def reward_bin(reward: float) -> int:
    """Number of the bin of a reward; rewards beyond the bins fall into the last one."""
    return int(np.clip(np.floor((reward - LOWEST) / BIN), 0, N_BINS - 1))


def bin_in_words(number: int) -> str:
    """The rewards of a bin; no single number, so that nobody takes it for the reward that was paid."""
    low = LOWEST + BIN * number
    if number == 0:
        return f"at most {low + BIN:+.1f}"
    return f"at least {low:+.1f}" if number == N_BINS - 1 else f"{low:+.1f} to {low + BIN:+.1f}"


BIN_MIDDLES = LOWEST + BIN * (np.arange(N_BINS) + 0.5)


PAID_FOR = {QUIET: f"points in {USUAL_SECONDS:g} seconds", KNOCK: "points for each", SPILL: "points for each"}
"""What the bins of some payments count; those of the others count the points of the act."""


def points_each(payment: int, reward: float, events: Events) -> float:
    """The reward for `USUAL_SECONDS` in which nothing happened, or for each object that was knocked or spilled."""
    if payment == QUIET:
        return reward * USUAL_SECONDS / max(events.seconds, 0.1)
    return reward / max(1, {KNOCK: len(events.knocked), SPILL: len(events.spilled)}.get(payment, 1))


class TabletopTask:
    """A job as the agent meets it.

    Parameters
    ----------
    job : JobReplay
    look : callable
        What the agent perceives of the job now; `TabletopFamily` chooses it by the agent's abilities.
    """

    def __init__(
        self, job: JobReplay, look: Callable[[TabletopJob], PerceivedTray | None] = look_at_raw_cloud
    ) -> None:
        self.job, self._look = job, look
        self._graph = TrayGraph()
        self.begin()

    # ---- the scene ----------------------------------------------------------------------------------

    def begin(self) -> None:
        """Begin an episode: look at the tray."""
        self.job.reset()
        self._done: Done = ()
        self._seen = self._looked()
        self.state = TrayState.seen(self._seen)
        self._graph.saw((), self.state)

    def _looked(self) -> PerceivedTray | None:
        return self.job.seen(self._look.__name__, self._look)

    @property
    def context(self) -> int:
        """Code of the target's perceived features, of what the hand holds, and of whether an act failed."""
        return context_of(self.state)

    def describe(self) -> str:
        """The perceived scene in a few words."""
        tray = self.state.tray
        if tray is None:
            return "a hidden target"
        load, room = self.state.load(tray.target), self.state.room(tray.target)
        return f"the target with {LOAD_NAMES[load]} on it and {ROOM_NAMES[room]}"

    # ---- acts ---------------------------------------------------------------------------------------

    def act(self, act: int) -> Step:
        """Act; an act that names something that is not there gives up."""
        before, job = self.state, self.job
        number = before.named().get(act)
        if number is None or not job.available()[VERB[act] * job.n_objects + number]:
            _, reward, ended = job.step(job.n_actions - 1)
            return Step(reward, (), ended)
        action = VERB[act] * job.n_objects + number
        observation, reward, ended = job.step(action)
        events = observation.last
        assert events is not None, "an action was taken"
        # A hand that holds something is in the picture: look when it is free again.
        looked = None if ended or observation.held is not None else self._looked()
        self._seen = looked
        result = result_of(events, act, looked is None or looked.room(looked.target, looked.objects) == 0)
        payment = before.payments(act)[result]
        effects = (
            (before.cause(act, number), result),
            (N_SITUATED + payment, reward_bin(points_each(payment, reward, events))),
        )
        self._done = (*self._done, (VERB[act], number))
        if not ended:
            after = before.after(act, number)[result]
            failed = frozenset() if after is None else after.failed
            if after is None or observation.held is None or after.held is None:
                after = TrayState.seen(looked or before.tray, failed)
            self.state = after
            self._graph.saw(self._done, after)
        self._graph.answered(self._done, Answer(result, reward, ended))
        return Step(reward, effects, ended)

    # ---- plans --------------------------------------------------------------------------------------

    def plan(self, laws: Array, tried: NDArray[np.bool_], new: int | None, shared: SharedKnowledge) -> Plan:
        """Plan over what acts lead to."""
        preferred = allowed = None
        if shared.guided and len(shared.acts):
            context = np.array([self.context])
            preferred, allowed = shared.acts.probs(context)[0], shared.acts.mask(context, ALLOWED)[0]
        return self._planner(self._done, laws, tried, new, preferred, allowed).plan()

    def best_acts(self, laws: Array, shared: SharedKnowledge) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """The best acts in the contexts of this task."""
        planner = self._planner((), laws[None], np.ones(laws.shape[0], np.bool_))
        first = {context_of(state): place for place, state in reversed(planner.edges.lived.items())}
        contexts = np.array(sorted(first), np.int64)
        return contexts, planner.best_acts(np.array([first[context] for context in contexts.tolist()], np.int64))

    def _planner(self, done: Done, laws: Array, tried: NDArray[np.bool_], *hints: Any) -> OutcomePlanner:
        edges = self._graph.edges(done)
        results = laws[:, edges.cause, :N_RESULTS]
        rewards = (laws[:, N_SITUATED:] @ BIN_MIDDLES)[:, edges.payments]
        known = edges.answer != UNKNOWN
        results[:, known] = np.eye(N_RESULTS)[edges.answer[known]]
        rewards[:, known] = edges.paid[known, None]
        tried = tried[edges.cause] | known
        return OutcomePlanner(edges, N_ACTS, results, rewards, tried, BRING, LONGEST - len(done), *hints)


def context_of(state: TrayState) -> int:
    """Code of a state's features for the prior over acts."""
    tray = state.tray
    hand = 0 if state.held is None else 1 if tray is not None and state.held == tray.target else 2
    load = room = below = 0
    if tray is not None and tray.target in state.here:
        load, room = state.load(tray.target), state.room(tray.target)
        below = bool(tray.rests_on(tray.target, state.here))
    situation = (load * len(ROOM_NAMES) + room) * 2 + below
    return (situation * len(HANDS) + hand) * 2 + bool(state.failed)
