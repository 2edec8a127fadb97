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
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.families.outcome_planning import OutcomeModel, OutcomePlanner
from lifelore.agent.long_lived.families.tray_features import (
    PerceivedTray,
    look_at_raw_cloud,
    look_with_labels,
    look_without_relations,
)
from lifelore.agent.long_lived.families.tray_graph import Answer, Done, TrayGraph
from lifelore.agent.long_lived.families.tray_states import (
    ACTS,
    HANDED,
    KNOCK,
    LOAD_NAMES,
    N_PICKS,
    N_PUSHES,
    N_SITUATED,
    PAYMENTS,
    QUIET,
    RESULTS,
    ROOM_NAMES,
    SPILL,
    VERB,
    TrayState,
    result_of,
)
from lifelore.agent.long_lived.families.tray_states import cause_name as situated_cause_name
from lifelore.agent.long_lived.task_family import Abilities, Plan, SharedKnowledge, Step
from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.domains.tabletop_job.best_return import OutcomeTree
from lifelore.domains.tabletop_job.events import Events
from lifelore.domains.tabletop_job.job import LONGEST, TabletopJob
from lifelore.domains.tabletop_job.job_replay import JobReplay
from lifelore.domains.tabletop_job.job_types import BRING, Gripper, JobType, job_type_named
from lifelore.domains.tabletop_job.tray import sample_tray
from lifelore.domains.task_stream import DrawnTask, TaskStream

Array = NDArray[np.float64]

HANDS = ("nothing", "the target", "another object")
N_ACTS, N_RESULTS = len(ACTS), len(RESULTS)
MOST_SEARCHED = 150
"""Sequences that the search for the best possible return looks at; where it ends before, the best known counts."""
ALLOWED = 0.05
"""Share of the counts of a context from which an act counts as sensible there."""
USUAL_SECONDS = 4.0
"""Seconds of an act, about: what waiting costs is counted for so long."""
BIN = 0.5
"""Width of a bin of rewards, points."""
LOWEST, N_BINS = -10.0, 43
FEATURES_TELL, POINTS_TELL = 8.0, 0.5
"""Weights of a type's laws of results, and of rewards, beside observations of the present task, in observations.

Features do not tell all of an object: one result says little of the next object. What a user pays stays the same.
"""


def reward_bin(reward: float) -> int:
    """Number of the bin of a reward; rewards beyond the bins fall into the last one."""
    return int(np.clip(np.floor((reward - LOWEST) / BIN), 0, N_BINS - 1))


BIN_MIDDLES = LOWEST + BIN * (np.arange(N_BINS) + 0.5)


def points_each(payment: int, reward: float, events: Events) -> float:
    """The reward for `USUAL_SECONDS` in which nothing happened, or for each object that was knocked or spilled."""
    if payment == QUIET:
        return reward * USUAL_SECONDS / max(events.seconds, 0.1)
    return reward / max(1, {KNOCK: len(events.knocked), SPILL: len(events.spilled)}.get(payment, 1))


@dataclass(frozen=True)
class TabletopFamily:
    """Tabletop jobs.

    Parameters
    ----------
    stream : TaskStream
        Its types are names of `job_types.JOB_TYPES`.
    seed : int
        Of the trays.
    labelled : bool
        Whether the points of the pictures carry the objects' labels; without, objects are cut automatically.
    trees : dict, optional
        Outcomes of (tray, gripper), shared between families that meet the same trays.
    tray_numbers : sequence of int, optional
        Number of the tray of each task; by default the task's own.
    """

    stream: TaskStream
    seed: int = 0
    labelled: bool = True
    trees: dict[tuple[int, str], OutcomeTree] = field(default_factory=dict)
    tray_numbers: tuple[int, ...] | None = None

    name = "tabletop trays"
    acts = ACTS
    n_causes = N_SITUATED + len(PAYMENTS)
    n_effects = N_BINS
    judges = np.ones(n_causes, np.bool_)

    @property
    def groups(self) -> NDArray[np.int64]:
        """Picks of one class of load; pushes of loaded objects and of others; every other cause alone."""
        found = np.arange(self.n_causes)
        found[:N_PICKS] -= found[:N_PICKS] % len(ROOM_NAMES)
        found[N_PICKS : N_PICKS + N_PUSHES] = N_PICKS + np.arange(N_PUSHES) % 2
        return found

    @property
    def possible(self) -> Array:
        """At first all results are equally likely; handing over the target pays, all else costs."""
        found = np.zeros((self.n_causes, self.n_effects))
        found[:N_SITUATED, :N_RESULTS] = 1 / N_RESULTS
        pays = np.isin(np.arange(len(PAYMENTS)), (HANDED, HANDED + 1))
        likely = (BIN_MIDDLES > 0) == pays[:, None]
        found[N_SITUATED:] = likely / likely.sum(axis=1, keepdims=True)
        return found

    @property
    def constancy(self) -> Array:
        """See `TaskFamily`."""
        return np.where(np.arange(self.n_causes) < N_SITUATED, FEATURES_TELL, POINTS_TELL)

    def smoothed(self, counts: Array) -> Array:
        """A reward counts for its own bin and, half, for the two beside it: seconds differ from tray to tray."""
        found = counts.copy()
        rewards = counts[:, N_SITUATED:]
        found[:, N_SITUATED:] = 0.5 * rewards
        found[:, N_SITUATED:, 1:] += 0.25 * rewards[:, :, :-1]
        found[:, N_SITUATED:, :-1] += 0.25 * rewards[:, :, 1:]
        return found

    def job(self, number: int, context: int | None = None) -> tuple[DrawnTask, JobReplay]:
        """Job `number`, with outcomes that equal actions share."""
        drawn = self.stream.draw(number, context)
        kind: JobType = job_type_named(drawn.hidden_type)
        tray = number if self.tray_numbers is None else self.tray_numbers[number]
        return drawn, JobReplay(self._tree(tray, kind.gripper), kind.user)

    def _tree(self, tray: int, gripper: Gripper) -> OutcomeTree:
        key = tray, gripper.name
        if key not in self.trees:
            self.trees[key] = OutcomeTree(sample_tray(self.seed, tray, TabletopSettings()), gripper)
        return self.trees[key]

    def meet(
        self, number: int, abilities: Abilities, context: int | None = None
    ) -> "tuple[DrawnTask, TabletopTask]":
        """Task `number`, drawn and met."""
        drawn, job = self.job(number, context)
        look = look_with_labels if self.labelled else look_at_raw_cloud
        return drawn, TabletopTask(job, look if abilities.perception else look_without_relations)

    def best_return(self, number: int, context: int | None = None) -> float:
        """The best possible return, from a search in the simulator."""
        _, job = self.job(number, context)
        return job.tree.best(job.user, MOST_SEARCHED).value

    def cause_name(self, cause: int) -> str:
        """A cause in words."""
        if cause < N_SITUATED:
            return situated_cause_name(cause)
        return f"{PAYMENTS[cause - N_SITUATED]}: reward"

    def effect_name(self, cause: int, effect: int) -> str:
        """An effect in words."""
        return RESULTS[effect] if cause < N_SITUATED else f"{BIN_MIDDLES[effect]:+.2f} points"


class TabletopTask:
    """A job as the agent meets it.

    Parameters
    ----------
    job : JobReplay
    look : callable
        What the agent perceives of the job now; `TabletopFamily` chooses it by the agent's abilities.
    """

    def __init__(
        self, job: JobReplay, look: Callable[[TabletopJob], PerceivedTray | None] = look_with_labels
    ) -> None:
        self.job, self._look = job, look
        self._graph = TrayGraph()
        self.begin()

    # ---- the scene ----------------------------------------------------------------------------------

    def begin(self) -> None:
        """Begin an episode: look at the tray."""
        self.job.reset()
        self._done: Done = ()
        self.state = TrayState.seen(self._looked())
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
        return OutcomePlanner(self._model(self._done, laws, tried), new, preferred, allowed).plan()

    def best_acts(self, laws: Array, shared: SharedKnowledge) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """The best acts in the contexts of this task."""
        planner = OutcomePlanner(self._model((), laws[None], np.ones(laws.shape[0], np.bool_)))
        lived = self._graph.nodes(()).lived
        first = {context_of(state): place for place, state in reversed(lived.items())}
        contexts = np.array(sorted(first), np.int64)
        return contexts, planner.best_acts(np.array([first[context] for context in contexts.tolist()], np.int64))

    def _model(self, done: Done, laws: Array, tried: NDArray[np.bool_]) -> OutcomeModel:
        nodes = self._graph.nodes(done)
        rewards = laws[:, N_SITUATED:] @ BIN_MIDDLES
        results = laws[:, nodes.causes, :N_RESULTS]
        expected = rewards[:, nodes.payments]
        results[:, nodes.answered] = nodes.answers
        expected[:, nodes.answered] = nodes.paid[:, None]
        known = tried[nodes.causes] | nodes.answered
        left = LONGEST - len(done)
        return OutcomeModel(nodes.available, results, expected, nodes.following, known, BRING, left)


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
