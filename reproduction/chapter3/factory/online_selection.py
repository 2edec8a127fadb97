"""Agents that go from one modified factory to the next and count each policy they end with, or the exact one.

One agent has a prior over all ten features of φ4, the other chooses features anew after each task (Alg. 6). The
thesis does not say which actions of a *learnt* policy count: ``tried``, those tried, in the states where any was;
``visited``, the same in states alone that promise a reward, a value above zero; ``all``, the best and tied-best
actions of every state, so all six of a state never seen. Of an *exact* policy ``all`` states count, or those on an
optimal ``way`` from the start. Thesis: §3.3.3, Alg. 6, §3.4.6, Figures 3.13 and 3.14.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.features.feature_selection import OnlineFeatureSelection
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.policy_counts import actions_to_count
from lifelore.core.errors import InputError
from lifelore.core.learning.curve import Curve
from lifelore.core.learning.q_learning import QLearner, Rows, Schedule
from lifelore.domains.factory.factory import ACTION_NAMES
from reproduction.chapter3.factory import modified_tasks
from reproduction.chapter3.factory.modified_tasks import FULL_SET, N_ACTIONS, Problem

UNIFORM, FULL, SELECTED = "uniform", "full", "selected"
SOURCES = ("learnt", "exact")


class Counting(NamedTuple):
    """Whose policy counts, and in which states.

    source : one of `SOURCES`
    over : "tried", "visited" or "all" of a learnt policy, "all" or "way" of an exact one
    """

    source: str
    over: str


def counted(problem: Problem, learner: QLearner | None, how: Counting) -> NDArray[np.bool_]:
    """Actions of each state that count, (n_states, 6); none of completed states."""
    if how.source == "learnt":
        if learner is None:
            raise InputError("learner must be given where learnt policies count; pass None for exact ones alone")
        q, ended = learner.q, problem.task.completed
        if how.over == "tried":
            # The rule of "visited" asks for a value above zero, which a shift grants to every action tried.
            q, over = q - q.min() + 1.0, "visited"
        else:
            over = how.over
        return actions_to_count(q, over, ended=ended, visits=learner.visits)
    if how.over == "all":
        return problem.best
    on_way = np.isin(np.arange(len(problem.best)), problem.way)
    return problem.best & on_way[:, None]


class OnlineAgent:
    """An agent whose prior grows task by task.

    Parameters
    ----------
    selects : bool
        Whether features are chosen after each task (Alg. 6); else all ten stay.
    counting : Counting
    alpha0 : float
    ties : {"uniform", "prior"}
    """

    def __init__(self, selects: bool, counting: Counting, alpha0: float, ties: str) -> None:
        self.counting, self.ties = counting, ties
        self._full = ActionPrior(N_ACTIONS, alpha0)
        self.selection = OnlineFeatureSelection(FULL_SET, ACTION_NAMES, alpha0) if selects else None

    def rows(self, problem: Problem) -> Rows:
        """ε-QPAP's rows with the prior so far (Alg. 4)."""
        probs = (self.selection or self._full).probs
        return modified_tasks.rows_of(problem, "phi4", probs, self.ties)

    def learn(self, problem: Problem, schedule: Schedule, *, explores: bool = True) -> Curve:
        """Learn a task, exploring by the prior or uniformly, and count its policy."""
        curve, learner = modified_tasks.learn_problem(problem, self.rows(problem) if explores else None, schedule)
        self.count(problem, learner)
        return curve

    def count(self, problem: Problem, learner: QLearner | None) -> None:
        """Count a policy; an exact one needs no learner."""
        codes, best = modified_tasks.contexts_of(problem, "phi4"), counted(problem, learner, self.counting)
        (self.selection or self._full).update(codes, best)

    @property
    def chosen(self) -> tuple[str, ...]:
        """Names of the features in use."""
        return self.selection.chosen.names if self.selection else FULL_SET.names
