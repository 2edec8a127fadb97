"""C3.11: one prior as proportions, as draws from a Dirichlet and as a softmax, in modified factories.

A run draws factories and lists of components for training and others for testing. The exact policies of the
training tasks, pooled by observation, make the prior; every form meets the same tasks and random numbers. The
thesis prints the softmax of the counts U and names no normalisation. An observation pools the counts of all states
that share it, which makes hundreds of them; read otherwise, U is divided by the number of policies, or the
softmax is that of the proportions. Thesis: §3.2.2.1, §3.4.7, Figure 3.15.
"""

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.learning.q_learning import Rows
from lifelore.core.metrics import Estimate, ratio_estimate
from lifelore.core.streams import stream
from lifelore.figures.style import BLUE, GREEN, VERMILION
from reproduction.chapter3.factory import comparison, modified_tasks
from reproduction.chapter3.factory.comparison import UNIFORM, Comparison
from reproduction.chapter3.factory.figure import one_panel
from reproduction.chapter3.factory.learning import Problem, rows_of, with_pseudo_count
from reproduction.engine.grid import Cell, Grid

PROPORTION, DIRICHLET, SOFTMAX = FORMS = ("proportion", "dirichlet", "softmax")
METHODS = (UNIFORM, *FORMS)
PAIRS = {
    "dirichlet_minus_proportion": (DIRICHLET, PROPORTION),
    "proportion_minus_softmax": (PROPORTION, SOFTMAX),
    "dirichlet_minus_softmax": (DIRICHLET, SOFTMAX),
    "early_proportion_minus_softmax": (PROPORTION, SOFTMAX, "early"),
}


def grid_of(settings: Mapping) -> Grid:
    """The grid; only the softmax reads what it is taken of."""
    keys = ("features", "schedule", "softmax_of", "ties", "alpha0", "max_steps", "policies")
    others = [key for key in keys if key != "softmax_of"]
    return comparison.grid_of(settings, keys[:3], keys[3:], {PROPORTION: others, DIRICHLET: others})


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: every form in every cell of the grid."""
    own = (seed, "C3.11", cell["run"])
    priors = modified_tasks.exact_priors(settings, (*own, "training"), settings["features"])

    def rows_of_form(form: str, how: Cell) -> Callable[[Problem], Rows]:
        prior = with_pseudo_count(priors[how["features"], how["policies"]], how["alpha0"])

        def rows_for(problem: Problem) -> Rows:
            random = stream(*problem.stream, "dirichlet")  # drawn from once for the task
            return rows_of(
                problem, how["features"], lambda codes: probs_of(prior, codes, form, how, random), how["ties"]
            )

        return rows_for

    return {**cell, **modified_tasks.compared(settings, grid_of(settings), own, METHODS, rows_of_form)}


def probs_of(
    prior: ActionPrior, codes: NDArray[np.int64], form: str, how: Cell, generator: np.random.Generator
) -> NDArray[np.float64]:
    """Action probabilities of codes in one of `FORMS`, (n, 6), rows sum to 1."""
    if form != SOFTMAX:
        return prior.probs(codes, form, generator=generator)
    if how["softmax_of"] == "proportions":
        mass = np.exp(prior.probs(codes))
        return mass / mass.sum(axis=1, keepdims=True)
    beta = 1.0 if how["softmax_of"] == "counts" else 1.0 / how["policies"]
    return prior.probs(codes, "softmax", beta=beta)


def _numbers(found: Comparison, cell: Mapping) -> dict[str, Estimate]:
    """Rewards compared, and the ratio of the early standard deviations across tasks."""
    softmax, proportion = (found.values(form, cell, "spread") for form in (SOFTMAX, PROPORTION))
    return {**found.shares(cell, PAIRS), "spread_ratio": ratio_estimate(softmax, proportion)}


measure, readings, rows = comparison.functions_of(grid_of, METHODS, _numbers)


LOOKS = {
    "softmax": ("softmax", VERMILION),
    "proportion": ("proportions", BLUE),
    "dirichlet": ("Dirichlet", GREEN),
}

draw = partial(one_panel, looks=LOOKS)
"""Figure of claim C3.11: rewards with three forms of one prior."""
