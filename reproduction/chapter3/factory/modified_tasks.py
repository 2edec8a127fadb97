"""Tasks of the modified factory, each with a layout of its own, solved and as learners meet them.

All methods meet a task with the same layout, list and random numbers, so that differences between methods are
paired. Thesis: §3.4.4.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np

from lifelore.action.features.feature_set import FeatureSet
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.learning.q_learning import Rows
from lifelore.core.streams import stream
from lifelore.domains.factory.contexts import FEATURE_NAMES, FEATURE_SIZES, PHI
from lifelore.domains.factory.modified_factory import modified_factory
from reproduction.chapter3.factory.comparison import UNIFORM, is_default, summary
from reproduction.chapter3.factory.learning import N_ACTIONS, Problem, contexts_of, solved_task
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.grid import Cell, Grid, run_grid
from reproduction.engine.learning_run import curves_of

FEATURE_WORDS = {
    "PosUM": "N", "PosML": "W", "PosMR": "E", "PosDM": "S", "PosMM": "own cell",
    "PosUL": "NW", "PosUR": "NE", "PosDL": "SW", "PosDR": "SE",
    "Items": "items", "Noise1": "noise 1", "Noise2": "noise 2",
}  # fmt: skip
"""A cell around the robot goes by its direction from the robot's own cell."""


def features_in_words(names: Sequence[str]) -> list[str]:
    """The features as ticks name them."""
    return [FEATURE_WORDS[name] for name in names]


FULL_SET = FeatureSet(FEATURE_NAMES, FEATURE_SIZES)
"""φ4: the ten features of the modified factory."""
CARDINALS = PHI["phi2"]
"""N, W, E and S of the robot's cell: the features that the thesis selects."""
FEATURES = (*CARDINALS, "PosMM", "PosUL", "PosUR", "PosDL", "PosDR", "Items")
"""All ten: first the four that the thesis finds to matter, then the others."""


def problem_of(settings: Mapping, names: tuple) -> Problem:
    """The problem that the streams of `names` draw: a layout, then a list of ``components`` components."""
    random = stream(*names, "factory")
    factory = modified_factory(random, settings["discount"])
    task = factory.task(factory.draw_components(random, settings["components"]))
    return solved_task(task)._replace(stream=names)


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
