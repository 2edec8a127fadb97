"""Tasks of the modified factory, each with a layout of its own, solved and as learners meet them.

All methods meet a task with the same layout, list and random numbers, so that differences between methods are
paired. Thesis: §3.4.4.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.features.feature_set import FeatureSet
from lifelore.core.learning.curve import Curve
from lifelore.core.learning.q_learning import QLearner, Rows, Schedule
from lifelore.core.mdp import Tables
from lifelore.core.planning.planning import best_actions
from lifelore.core.streams import stream
from lifelore.domains.factory.contexts import (
    FEATURE_NAMES,
    FEATURE_SIZES,
    PHI,
    feature_codes,
    features,
    state_contexts,
)
from lifelore.domains.factory.factory import ACTION_NAMES, FactoryTask
from lifelore.domains.factory.modified_factory import modified_factory
from lifelore.experiments.chapter3.factory.learning import optimal_way
from lifelore.experiments.engine.learning_run import learnt

N_ACTIONS = len(ACTION_NAMES)
FULL_SET = FeatureSet(FEATURE_NAMES, FEATURE_SIZES)
"""φ4: the ten features of the modified factory."""
CARDINALS = PHI["phi2"]
"""N, W, E and S of the robot's cell: the features that the thesis selects."""
DIAGONALS = ("PosUL", "PosUR", "PosDL", "PosDR")
OWN_CELL, ITEMS = "PosMM", "Items"
FEATURES = (*CARDINALS, OWN_CELL, *DIAGONALS, ITEMS)
"""All ten: first the four that the thesis finds to matter, then the others."""


class Problem(NamedTuple):
    """A task, its exact solution, and the names of its streams.

    best : (n_states, 6) bool, best and tied-best actions; completed rows empty, nothing is chosen there
    seen : (n_states, 10) int8, values of the features of `FULL_SET`
    way : (n_steps,) int, states in which an optimal policy acts, from the start to the end
    optimal : summed reward of an episode of that policy
    """

    task: FactoryTask
    tables: Tables
    best: NDArray[np.bool_]
    seen: NDArray[np.int8]
    way: NDArray[np.int64]
    optimal: float
    stream: tuple


def problem_of(settings: Mapping, names: tuple) -> Problem:
    """The problem that the streams of `names` draw: a layout, then a list of ``components`` components."""
    random = stream(*names, "factory")
    factory = modified_factory(random, settings["discount"])
    task = factory.task(factory.draw_components(random, settings["components"]))
    tables = task.tables()
    q = task.optimal_q(tables)
    best = best_actions(q)
    best[task.completed] = False
    way, optimal = optimal_way(tables, best)
    return Problem(task, tables, best, features(task), way, optimal, names)


def contexts_of(problem: Problem, conditioned_on: str) -> NDArray[np.int64]:
    """Codes of all states, (n_states,): by a set φ of `PHI`, or by ``state`` and an encoding: ``state global``."""
    if conditioned_on in PHI:
        return feature_codes(problem.seen, conditioned_on)
    return state_contexts(problem.task, conditioned_on.removeprefix("state "))


def learn_problem(problem: Problem, rows: Rows | None, schedule: Schedule) -> tuple[Curve, QLearner]:
    """The curve and the learner after all episodes; without `rows` it is plain Q-learning."""
    return learnt(problem.tables, problem.stream, rows, schedule)
