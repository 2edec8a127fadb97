"""Tabletop jobs as tasks of the long-lived agent: their causes, their effects, and what is like what."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.families.tabletop_task import (
    BIN_MIDDLES,
    N_BINS,
    N_RESULTS,
    PAID_FOR,
    TabletopTask,
    bin_in_words,
)
from lifelore.agent.long_lived.families.tray_features import (
    look_at_raw_cloud,
    look_without_relations,
)
from lifelore.agent.long_lived.families.tray_states import (
    ACTS,
    HANDED,
    N_PICKS,
    N_PUSHES,
    N_SITUATED,
    PAYMENTS,
    RESULTS,
    ROOM_NAMES,
    WITH_SPILL,
)
from lifelore.agent.long_lived.families.tray_states import cause_name as situated_cause_name
from lifelore.agent.long_lived.task_family import Abilities, TaskFamily
from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.domains.tabletop_job.best_return import OutcomeTree
from lifelore.domains.tabletop_job.job_replay import JobReplay
from lifelore.domains.tabletop_job.job_types import Gripper, JobType, job_type_named
from lifelore.domains.tabletop_job.tray import sample_tray
from lifelore.domains.task_stream import DrawnTask, TaskStream

Array = NDArray[np.float64]

MOST_SEARCHED = 150
"""Sequences that the search for the best possible return looks at; where it ends before, the best known counts."""
FEATURES_TELL, POINTS_TELL = 8.0, 0.5
"""Weights of a type's laws of results, and of rewards, beside observations of the present task, in observations.

Features do not tell all of an object: one result says little of the next object. What a user pays stays the same.
"""
UNLIKELY = 0.02
"""Weight of a reward of the wrong sign before any was seen: a spill can cost more than the target pays."""
N_CAUSES = N_SITUATED + len(PAYMENTS)


def _groups() -> NDArray[np.int64]:
    """Picks of one class of load; pushes of loaded objects and of others; every other cause alone."""
    found = np.arange(N_CAUSES)
    found[:N_PICKS] -= found[:N_PICKS] % len(ROOM_NAMES)
    found[N_PICKS : N_PICKS + N_PUSHES] = N_PICKS + np.arange(N_PUSHES) % 2
    return found


def _possible() -> Array:
    """At first all results are equally likely; handing over the target pays, all else costs."""
    found = np.zeros((N_CAUSES, N_BINS))
    found[:N_SITUATED, :N_RESULTS] = 1 / N_RESULTS
    target = (HANDED, HANDED + 1, HANDED + WITH_SPILL, HANDED + 1 + WITH_SPILL)
    pays = np.isin(np.arange(len(PAYMENTS)), target)
    likely = np.where((BIN_MIDDLES > 0) == pays[:, None], 1.0, UNLIKELY)
    found[N_SITUATED:] = likely / likely.sum(axis=1, keepdims=True)
    return found


@dataclass(frozen=True)
class TabletopFamily(TaskFamily):
    """Tabletop jobs.

    Parameters
    ----------
    stream : TaskStream
        Its types are names of `job_types.JOB_TYPES`.
    seed : int
        Of the trays.
    trees : dict, optional
        Outcomes of (tray, gripper), shared between families that meet the same trays.
    """

    stream: TaskStream
    seed: int = 0
    trees: dict[tuple[int, str], OutcomeTree] = field(default_factory=dict)

    name = "tabletop jobs"
    domain = "tabletop"
    acts = ACTS
    n_causes = N_CAUSES
    n_effects = N_BINS
    groups = _groups()
    # What picks and pushes result in; putting aside and handing over; rewards.
    kinds = np.repeat([0, 1, 2], [N_PICKS + N_PUSHES, N_SITUATED - N_PICKS - N_PUSHES, len(PAYMENTS)])
    possible = _possible()
    constancy = np.repeat([FEATURES_TELL, POINTS_TELL], [N_SITUATED, len(PAYMENTS)])

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
        return drawn, JobReplay(self._tree(number, kind.gripper), kind.user)

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
        return drawn, TabletopTask(job, look_at_raw_cloud if abilities.perception else look_without_relations)

    def best_return(self, number: int, context: int | None = None) -> float:
        """The best possible return, from a search in the simulator."""
        _, job = self.job(number, context)
        return job.tree.best(job.user, MOST_SEARCHED).value

    def cause_name(self, cause: int) -> str:
        """A cause in words."""
        if cause < N_SITUATED:
            return situated_cause_name(cause)
        payment = cause - N_SITUATED
        return f"{PAYMENTS[payment]}: {PAID_FOR.get(payment, 'points')}"

    def effect_name(self, cause: int, effect: int) -> str:
        """An effect in words."""
        return RESULTS[effect] if cause < N_SITUATED else bin_in_words(effect)
