"""Tasks of the modified factory, each with a layout of its own, solved and as learners meet them.

All methods meet a task with the same layout, list and random numbers, so that differences between methods are
paired. Thesis: §3.4.4.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.features.feature_set import FeatureSet
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import prior_rows
from lifelore.core.learning.curve import Curve
from lifelore.core.learning.q_learning import Rows, Schedule
from lifelore.core.mdp import Tables
from lifelore.core.planning.planning import best_actions
from lifelore.core.streams import stream
from lifelore.domains.factory import contexts
from lifelore.domains.factory.contexts import FEATURE_NAMES, FEATURE_SIZES, PHI
from lifelore.domains.factory.factory import ACTION_NAMES, FactoryTask
from lifelore.domains.factory.modified_factory import modified_factory
from reproduction.chapter3.factory.comparison import UNIFORM, is_default, summary
from reproduction.chapter3.factory.learning import optimal_way
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.grid import Cell, Grid, run_grid
from reproduction.engine.learning_run import learnt

N_ACTIONS = len(ACTION_NAMES)
FULL_SET = FeatureSet(FEATURE_NAMES, FEATURE_SIZES)
"""φ4: the ten features of the modified factory."""
CARDINALS = PHI["phi2"]
"""N, W, E and S of the robot's cell: the features that the thesis selects."""
FEATURES = (*CARDINALS, "PosMM", "PosUL", "PosUR", "PosDL", "PosDR", "Items")
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
    return Problem(task, tables, best, contexts.features(task), way, optimal, names)


def contexts_of(problem: Problem, conditioned_on: str) -> NDArray[np.int64]:
    """Codes of all states, (n_states,): by a set φ of `PHI`, or by ``state`` and an encoding: ``state global``."""
    if conditioned_on in PHI:
        return contexts.feature_codes(problem.seen, conditioned_on)
    return contexts.state_contexts(problem.task, conditioned_on.removeprefix("state "))


def problems_of(settings: Mapping, names: tuple, n: int) -> list[Problem]:
    """`n` problems; more of them leave the first ones as they are."""
    return [problem_of(settings, (*names, i)) for i in range(n)]


def exact_priors(settings: Mapping, names: tuple, conditions: Iterable[str]) -> dict[tuple[str, int], ActionPrior]:
    """Priors with α⁰ = 1 from exact policies, by what they are conditioned on and how many ``policies`` count."""
    counting, found = {name: ActionPrior(N_ACTIONS, 1.0) for name in conditions}, {}
    for i in range(max(settings["policies"])):
        problem = problem_of(settings, (*names, i))
        for name, prior in counting.items():
            prior.update(contexts_of(problem, name), problem.best)
            if i + 1 in settings["policies"]:
                found[name, i + 1] = ActionPrior.merged([prior])
    return found


def rows_of(problem: Problem, conditioned_on: str, probs_of: Callable, ties: str) -> Rows:
    """ε-QPAP's rows (Alg. 4) with the prior whose ``probs`` are `probs_of`; over states they are ε-QSAP's."""
    return prior_rows(problem.tables, contexts_of(problem, conditioned_on), probs_of, ties)


def curves_of(
    problems: Iterable[Problem], rows_for: Callable[[Problem], Rows | None], schedule: Schedule
) -> list[Curve]:
    """The curve of each problem."""
    return [learnt(problem.tables, problem.stream, rows_for(problem), schedule)[0] for problem in problems]


def rewards_of(
    problems: Iterable[Problem], rows_for: Callable[[Problem], Rows | None], schedule: Schedule
) -> NDArray[np.float64]:
    """Reward of each episode of each problem, (n_problems, n_episodes)."""
    return np.array([curve.rewards for curve in curves_of(problems, rows_for, schedule)])


def compared(
    settings: Mapping,
    grid: Grid,
    names: tuple,
    methods: Sequence[str],
    rows_of_method: Callable[[str, Cell], Callable[[Problem], Rows]],
) -> dict:
    """A run of a `Comparison`: every method in every cell of the grid, in test tasks of the streams of `names`.

    ``rows_of_method(method, cell)`` gives the rows of each problem; plain Q-learning is not asked for.
    """
    testing = problems_of(settings, (*names, "testing"), settings["test_tasks"])

    def numbers(method: str, how: Cell) -> dict:
        rows_for = (lambda _: None) if method == UNIFORM else rows_of_method(method, how)
        schedule = schedule_of({**settings, "max_steps": how["max_steps"]}, how["schedule"])
        return summary(curves_of(testing, rows_for, schedule), settings["early"], is_default(grid, how))

    found = list(run_grid(grid, methods, numbers))
    return {"optimal": float(np.mean([problem.optimal for problem in testing])), "found": found}
