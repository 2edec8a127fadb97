"""Tabletop jobs as the long-lived agent meets them: acts and causes in words of the perceived tray.

A context is what the agent perceives: what is on, beside and under the target, what the hand holds, and whether
the last act failed. Two kinds of causes have effects that depend on the hidden type:

- an act in a situation: it is done, or it misses, slips, knocks or spills (the gripper);
- a deed with that result: the reward, in bins (the user). Deeds are acts, told apart by whether the hand holds the
  target or another object.

Which context follows is the same for all types and is learnt once (`SharedKnowledge.moves`).
"""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.long_lived.families.context_planning import ContextModel, ContextPlanner
from lifelore.agent.long_lived.families.tray_features import (
    TrayFeatures,
    look_at_raw_cloud,
    look_with_labels,
    look_without_relations,
)
from lifelore.agent.long_lived.task_family import Abilities, Plan, SharedKnowledge, Step
from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.domains.tabletop_job.best_return import OutcomeTree
from lifelore.domains.tabletop_job.events import Events
from lifelore.domains.tabletop_job.job import (
    HAND_OVER_BRISKLY,
    HAND_OVER_GENTLY,
    LONGEST,
    PICK,
    PUSH_APART,
    PUT_ASIDE,
)
from lifelore.domains.tabletop_job.job_replay import JobReplay
from lifelore.domains.tabletop_job.job_types import BRING, Gripper, JobType, job_type_named
from lifelore.domains.tabletop_job.tray import sample_tray
from lifelore.domains.task_stream import DrawnTask, TaskStream

Array = NDArray[np.float64]

ACTS = (
    "pick the target",
    "pick what is on top of it",
    "pick its neighbour",
    "push the target apart",
    "push its neighbour apart",
    "put aside",
    "hand over gently",
    "hand over briskly",
    "give up",
)
PICK_TARGET, PICK_TOP, PICK_NEIGHBOUR, PUSH_TARGET, PUSH_NEIGHBOUR, ASIDE, GENTLY, BRISKLY, GIVE_UP = range(9)
VERB = (PICK, PICK, PICK, PUSH_APART, PUSH_APART, PUT_ASIDE, HAND_OVER_GENTLY, HAND_OVER_BRISKLY)
RESULTS = ("done", "missed", "slipped", "knocked another", "spilled")
DONE, MISSED, SLIPPED, KNOCKED, SPILLED = range(5)
HANDS = ("nothing", "the target", "another object")
ABOVE = ("nothing on it", "perhaps something on it", "an object on it", "a stack on it")
BESIDE = ("nothing beside it", "a neighbour near", "a neighbour that touches")

N_SITUATIONS = len(ABOVE) * len(BESIDE) * 2
N_CONTEXTS = N_SITUATIONS * len(HANDS) * 2
END = N_CONTEXTS
N_ACTS, N_RESULTS = len(ACTS), len(RESULTS)
MEANT = 0.5
"""Weight of what an act is meant to do, in observations."""
N_DEEDS = GIVE_UP + 3
"""The acts, and those of a hand that holds another object than the target."""
N_SITUATED = N_SITUATIONS * GIVE_UP
"""Causes of results: an act in a situation; the causes of rewards follow."""
MOST_SEARCHED = 150
"""Sequences that the search for the best possible return looks at; where it ends before, the best known counts."""
OWN = 3.0
"""Weight of a move of the present task beside those of earlier tasks: it is about this very scene."""
BIN = 0.5
"""Width of a bin of rewards, points."""
LOWEST, N_BINS = -10.0, 43


def reward_bin(reward: float) -> int:
    """Number of the bin of a reward; rewards beyond the bins fall into the last one."""
    return int(np.clip(np.floor((reward - LOWEST) / BIN), 0, N_BINS - 1))


BIN_MIDDLES = LOWEST + BIN * (np.arange(N_BINS) + 0.5)


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

    name = "tabletop"
    acts = ACTS
    n_causes = N_SITUATED + N_DEEDS * N_RESULTS
    n_effects = N_BINS
    n_results = N_CONTEXTS + 1
    judges = np.ones(n_causes, np.bool_)

    @property
    def groups(self) -> NDArray[np.int64]:
        """An act in all situations; each cause of rewards alone."""
        causes = np.arange(self.n_causes)
        return np.where(causes < N_SITUATED, causes % GIVE_UP, causes)

    @property
    def possible(self) -> Array:
        """All results, and all bins of rewards, are equally likely before anything was seen."""
        found = np.zeros((self.n_causes, self.n_effects))
        found[:N_SITUATED, :N_RESULTS] = 1 / N_RESULTS
        found[N_SITUATED:] = 1 / N_BINS
        return found

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
        return drawn, TabletopTask(job, abilities.perception, self.labelled)

    def best_return(self, number: int, context: int | None = None) -> float:
        """The best possible return, from a search in the simulator."""
        _, job = self.job(number, context)
        return job.tree.best(job.user, MOST_SEARCHED).value

    def cause_name(self, cause: int) -> str:
        """A cause in words."""
        if cause < N_SITUATED:
            situation, act = divmod(cause, GIVE_UP)
            return f"{ACTS[act]} ({_situation_name(situation)})"
        deed, result = divmod(cause - N_SITUATED, N_RESULTS)
        name = ACTS[deed] if deed < GIVE_UP else f"{ACTS[deed - GIVE_UP + ASIDE]} another object"
        return f"{name}, {RESULTS[result]}: reward"

    def effect_name(self, cause: int, effect: int) -> str:
        """An effect in words."""
        return RESULTS[effect] if cause < N_SITUATED else f"{BIN_MIDDLES[effect]:+.2f} points"


def _situation_name(situation: int) -> str:
    rest, below = divmod(situation, 2)
    above, beside = divmod(rest, len(BESIDE))
    return f"{ABOVE[above]}, {BESIDE[beside]}" + (", on another object" if below else "")


class TabletopTask:
    """A job as the agent meets it.

    Parameters
    ----------
    job : JobReplay
    perception, labelled : bool
        Whether relations are perceived, and whether from points with labels.
    """

    def __init__(self, job: JobReplay, perception: bool = True, labelled: bool = True) -> None:
        self.job = job
        self._look = (
            look_without_relations if not perception else look_with_labels if labelled else look_at_raw_cloud
        )
        self._visited: set[int] = set()
        self._followed = ActionPrior(N_CONTEXTS + 1)
        self.begin()

    # ---- the scene ----------------------------------------------------------------------------------

    def begin(self) -> None:
        """Begin an episode: look at the tray."""
        self.job.reset()
        self.seen, self._failed = self._looked(), 0
        self.moved: tuple[int, int] | None = None
        self._visited.add(self.context)

    def _looked(self) -> TrayFeatures | None:
        return self.job.seen(self._look.__name__, self._look)

    @property
    def context(self) -> int:
        """Code of the perceived features."""
        observation = self.job.observation
        held = observation.held
        hand = 0 if held is None else 1 if held == observation.target else 2
        return (self._situation * len(HANDS) + hand) * 2 + self._failed

    @property
    def _situation(self) -> int:
        seen = self.seen
        if seen is None:
            return 0
        return (seen.above * len(BESIDE) + seen.beside) * 2 + seen.below

    def describe(self) -> str:
        """The perceived scene in a few words."""
        return f"the target with {_situation_name(self._situation)}"

    # ---- acts ---------------------------------------------------------------------------------------

    def act(self, act: int) -> Step:
        """Act; an act that names something that is not there gives up."""
        before, job = self.context, self.job
        number = self._named(act)
        if act == GIVE_UP or number is None:
            _, reward, ended = job.step(job.n_actions - 1)
            self.moved = None
            return Step(reward, (), ended)
        observation, reward, ended = job.step(VERB[act] * job.n_objects + number)
        events = observation.last
        assert events is not None, "an action was taken"
        result = _result(events)
        situation = self._situation if act < ASIDE else 0
        deed = int(_deeds(np.array([before]))[0, act])
        effects = (
            (situation * GIVE_UP + act, result),
            (N_SITUATED + deed * N_RESULTS + result, reward_bin(reward)),
        )
        if not ended:
            self._follow(act, number, result)
        self.moved = (before * GIVE_UP + act) * N_RESULTS + result, END if ended else self.context
        self._followed.update_trajectory([self.moved[0]], [self.moved[1]], OWN)
        self._visited.add(self.context)
        return Step(reward, effects, ended)

    def _named(self, act: int) -> int | None:
        """The object that an act is about."""
        held, seen = self.job.observation.held, self.seen
        if act in (ASIDE, GENTLY, BRISKLY):
            return held
        if held is not None or seen is None:
            return None
        if act in (PICK_TARGET, PUSH_TARGET):
            return seen.target
        found = seen.top if act == PICK_TOP else seen.neighbour
        return None if found in self.job.observation.gone else found

    def _follow(self, act: int, number: int, result: int) -> None:
        """See what has changed: look again where more than the named object may have moved."""
        self._failed = int(result in (MISSED, SLIPPED))
        if act in (PICK_TARGET, PICK_TOP, PICK_NEIGHBOUR) and result == DONE:
            return  # the hand is in the picture: look when it is free again
        self.seen = self._looked() or (None if self.seen is None else replace(self.seen, above=0, beside=0))

    # ---- plans --------------------------------------------------------------------------------------

    def plan(self, laws: Array, tried: NDArray[np.bool_], new: int | None, shared: SharedKnowledge) -> Plan:
        """Plan over contexts."""
        model = self._model(laws, tried, shared)
        return ContextPlanner(model, new, shared.acts if shared.guided else None).plan(self.context)

    def best_acts(self, laws: Array, shared: SharedKnowledge) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """The best acts in the contexts of this task."""
        tried = np.ones(laws.shape[0], np.bool_)
        planner = ContextPlanner(self._model(laws[None], tried, shared), None, None)
        contexts = np.array(sorted(self._visited), np.int64)
        return contexts, planner.best_acts(contexts)

    def _model(self, laws: Array, tried: NDArray[np.bool_], shared: SharedKnowledge) -> ContextModel:
        known = shared.moves.contexts // (GIVE_UP * N_RESULTS)
        contexts = np.union1d(known, np.fromiter(self._visited | {self.context}, np.int64))
        moves = _moves(contexts, shared.moves, self._followed)
        causes = _situated_causes(contexts)
        rewards = laws[:, N_SITUATED:] @ BIN_MIDDLES
        return ContextModel(
            contexts,
            available_acts(contexts),
            laws[:, causes, :N_RESULTS],
            rewards.reshape(-1, N_DEEDS, N_RESULTS)[:, _deeds(contexts)],
            moves,
            tried[causes],
            BRING,
            LONGEST - self.job.observation.n_actions_taken,
        )


def _deeds(contexts: NDArray[np.int64]) -> NDArray[np.int64]:
    """(n, n_acts - 1) the deed that an act is in each context."""
    acts = np.arange(GIVE_UP)
    other = (contexts // 2 % len(HANDS) == 2)[:, None] & (acts >= ASIDE)
    return np.where(other, GIVE_UP + acts - ASIDE, acts)


def _situated_causes(contexts: NDArray[np.int64]) -> NDArray[np.int64]:
    """(n, n_acts - 1) the cause of each act in each context; what the hand holds is put down alike anywhere."""
    acts = np.arange(GIVE_UP)
    situation = np.where(acts < ASIDE, situation_of(contexts)[:, None], 0)
    return situation * GIVE_UP + acts


def _moves(contexts: NDArray[np.int64], counted: ActionPrior, own: ActionPrior) -> Array:
    """P(next context | context, act, result): what followed, in this task too, and at first what is meant to."""
    n = len(contexts)
    acts, results = np.arange(GIVE_UP), np.arange(N_RESULTS)
    meant = np.searchsorted(contexts, _meant(contexts))
    found = np.zeros((n, GIVE_UP, N_RESULTS, n + 1))
    inside = (meant < n) & (np.append(contexts, -1)[meant] == _meant(contexts))
    meant = np.where(inside, meant, n)
    i, a, r = np.indices((n, GIVE_UP, N_RESULTS))
    found[i, a, r, meant] = MEANT
    codes = (contexts[:, None, None] * GIVE_UP + acts[:, None]) * N_RESULTS + results
    rows = (counted.counts(codes.ravel()) + own.counts(codes.ravel())).reshape(n, GIVE_UP, N_RESULTS, -1)
    found[..., :n] += rows[..., contexts]
    found[..., n] += rows[..., END]
    return found / found.sum(axis=3, keepdims=True)


def _meant(contexts: NDArray[np.int64]) -> NDArray[np.int64]:
    """(n, n_acts - 1, n_results) the context that an act is meant to lead to; `END` once the target is handed."""
    situation, hand = situation_of(contexts)[:, None], (contexts // 2 % len(HANDS))[:, None]
    acts = np.arange(GIVE_UP)[None]
    below = situation % 2
    picks, pushes, frees = acts <= PICK_NEIGHBOUR, (acts == PUSH_TARGET) | (acts == PUSH_NEIGHBOUR), acts >= ASIDE
    after = np.where(pushes, situation - situation // 2 % len(BESIDE) * 2, np.where(frees, below, situation))
    held = np.where(picks, np.where(acts == PICK_TARGET, 1, 2), np.where(frees, 0, hand))
    done = (after * len(HANDS) + held) * 2
    done = np.where((acts >= GENTLY) & (hand == 1), END, done)
    missed = (situation * len(HANDS)) * 2 + 1
    found = np.repeat(done[:, :, None], N_RESULTS, axis=2)
    found[:, :, [MISSED, SLIPPED]] = missed[:, :, None]
    return found


def situation_of(contexts: NDArray[np.int64]) -> NDArray[np.int64]:
    """The situations of contexts."""
    return contexts // (2 * len(HANDS))


def _result(events: Events) -> int:
    if events.spilled or events.lost:
        return SPILLED
    if events.knocked:
        return KNOCKED
    if events.slipped:
        return SLIPPED
    return DONE if events.reached else MISSED


def available_acts(contexts: NDArray[np.int64]) -> NDArray[np.bool_]:
    """(n, n_acts) which acts the contexts (n,) offer."""
    situation, hand = situation_of(contexts), contexts // 2 % len(HANDS)
    above, beside = situation // (2 * len(BESIDE)), situation // 2 % len(BESIDE)
    found = np.zeros((len(contexts), N_ACTS), np.bool_)
    free = hand == 0
    found[:, [PICK_TARGET, PUSH_TARGET]] = free[:, None]
    found[:, PICK_TOP] = free & (above > 0)
    found[:, [PICK_NEIGHBOUR, PUSH_NEIGHBOUR]] = (free & (beside > 0))[:, None]
    found[:, [ASIDE, GENTLY, BRISKLY]] = ~free[:, None]
    found[:, GIVE_UP] = True
    return found
