"""Agents that go from one modified factory to the next and count each policy they end with, or the exact one.

One agent has a prior over all ten features of φ4, the other chooses features anew after each task (Alg. 6).
Thesis: §3.3.3, Alg. 6, §3.4.6, Figures 3.13 and 3.14.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.action.features.feature_selection import OnlineFeatureSelection
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.policy_counts import actions_to_count
from lifelore.core.learning.curve import Curve
from lifelore.core.learning.q_learning import QLearner, Schedule
from lifelore.domains.factory.factory import ACTION_NAMES
from reproduction.chapter3.factory.learning import N_ACTIONS, Problem, contexts_of, rows_of, tried_actions
from reproduction.chapter3.factory.modified_tasks import FULL_SET
from reproduction.engine.learning_run import learnt

FULL, SELECTED = "full", "selected"
SOURCES = ("learnt", "learnt, all states", "exact", "exact, on the way")
"""Policies that count, a choice left open. A learnt one counts in the states where it tried any action, or in all
(with all six actions of a state never seen); an exact one in all states, or in those of an optimal way."""


def counted(problem: Problem, learner: QLearner, source: str) -> NDArray[np.bool_]:
    """Actions of each state that count, (n_states, 6); none of completed states."""
    ended = problem.task.completed
    if source == "learnt":
        return tried_actions(learner, ended)
    if source == "learnt, all states":
        return actions_to_count(learner.q, "all", ended=ended)
    if source == "exact":
        return problem.best
    on_way = np.isin(np.arange(len(problem.best)), problem.way)
    return problem.best & on_way[:, None]


class OnlineAgent:
    """An agent whose prior grows task by task.

    Parameters
    ----------
    selects : bool
        Whether features are chosen after each task (Alg. 6); else all ten stay.
    source : str
        One of `SOURCES`.
    alpha0 : float
    ties : {"uniform", "prior"}
    """

    def __init__(self, selects: bool, source: str, alpha0: float, ties: str) -> None:
        self.source, self.ties = source, ties
        self._full = ActionPrior(N_ACTIONS, alpha0)
        self.selection = OnlineFeatureSelection(FULL_SET, ACTION_NAMES, alpha0) if selects else None

    def learn(self, problem: Problem, schedule: Schedule) -> Curve:
        """Learn a task by ε-QPAP with the prior so far (Alg. 4), and count its policy."""
        prior = self.selection or self._full
        rows = rows_of(problem, "phi4", prior.probs, self.ties)
        curve, learner = learnt(problem.tables, problem.stream, rows, schedule)
        prior.update(contexts_of(problem, "phi4"), counted(problem, learner, self.source))
        return curve

    @property
    def chosen(self) -> tuple[str, ...]:
        """Names of the features in use."""
        return self.selection.chosen.names if self.selection else FULL_SET.names
