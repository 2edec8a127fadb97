"""C3.11: one prior as proportions, as draws from a Dirichlet and as softmaxes, in modified factories.

A run draws factories and lists of components for training and others for testing. The exact policies of the
training tasks, pooled by observation, make the prior; every form meets the same tasks and random numbers. The
thesis prints the softmax of the counts U. An observation pools the counts of all states that share it, which makes
hundreds of them, and the thesis names no normalisation: U is also divided by the number of policies, and the
softmax is also taken of the proportions, times a scale. An optimal episode's moves cost about what its task pays,
so that its reward lies near 0; the first reading's scale of *comparable* is the distance from learning without a
prior to the optimum, the second's the absolute value of the optimal reward, a mean over tasks.
Thesis: §3.2.2.1, §3.4.7, Figure 3.15.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.learning.q_learning import Rows
from lifelore.core.streams import stream
from reproduction.chapter3.factory import modified_tasks
from reproduction.chapter3.factory.learning import with_pseudo_count
from reproduction.chapter3.factory.modified_tasks import Problem
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.grid import Grid, run_grid

WITHOUT_PRIOR, PROPORTION, DIRICHLET, AS_PRINTED = "uniform", "proportion", "dirichlet", "softmax of counts"
SCALE = {"softmax of proportions": 1.0, "softmax of 10 × proportions": 10.0}
FORMS = (PROPORTION, DIRICHLET, AS_PRINTED, "softmax of counts a policy", *SCALE)
SOFTMAXES = FORMS[2:]
KEYS = ("features", "schedule", "ties", "alpha0", "max_steps", "policies")


class Tasks(NamedTuple):
    """Priors by set of features and number of policies, with α⁰ of 1, and test tasks."""

    priors: dict[tuple[str, int], ActionPrior]
    testing: list[Problem]


def grid_of(settings: Mapping) -> Grid:
    """Features × ε × ties, and every other α⁰, cap of steps and number of policies, one at a time."""
    crossed = {"features": "features", "schedule": "schedules", "ties": "ties"}
    return Grid.crossed(settings, KEYS, crossed, {key: key for key in ("alpha0", "max_steps", "policies")})


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: every form in every cell of the grid."""
    run, grid = run_of(settings, seed, cell["run"]), grid_of(settings)

    def numbers(form: str, how: Mapping) -> dict:
        prior = None
        if form != WITHOUT_PRIOR:
            prior = with_pseudo_count(run.priors[how["features"], how["policies"]], how["alpha0"])

        def rows_for(problem: Problem) -> Rows | None:
            return None if prior is None else rows_of(problem, prior, form, how)

        schedule = schedule_of({**settings, "max_steps": how["max_steps"]}, how["schedule"])
        rewards = modified_tasks.rewards_of(run.testing, rows_for, schedule)
        curve = modified_tasks.curve_across(rewards) if grid.is_default_but_for_schedule(how) else {}
        return {**summary(rewards, settings["early"]), **curve}

    optimal = [problem.optimal for problem in run.testing]
    means = {"optimal": float(np.mean(optimal)), "optimal_size": float(np.abs(optimal).mean())}
    return {**cell, **means, "found": list(run_grid(grid, "form", WITHOUT_PRIOR, FORMS, numbers))}


def run_of(settings: Mapping, seed: int, number: int) -> Tasks:
    """Run `number`."""
    own = (seed, "C3.11", number)
    priors = modified_tasks.exact_priors(settings, (*own, "training"), settings["features"])
    return Tasks(priors, modified_tasks.problems_of(settings, (*own, "testing"), settings["test_tasks"]))


def rows_of(problem: Problem, prior: ActionPrior, form: str, how: Mapping) -> Rows:
    """Rows of ε-QPAP; a Dirichlet is drawn from once for the task."""
    random = stream(*problem.stream, "dirichlet")

    def probs(codes):
        return probs_of(prior, codes, form, how["policies"], random)

    return modified_tasks.rows_of(problem, how["features"], probs, how["ties"])


def probs_of(
    prior: ActionPrior, codes: NDArray[np.int64], form: str, policies: int, generator: np.random.Generator
) -> NDArray[np.float64]:
    """Action probabilities of codes in one of `FORMS`, (n, 6), rows sum to 1."""
    if form in SCALE:
        share = SCALE[form] * prior.probs(codes)
        mass = np.exp(share - share.max(axis=1, keepdims=True))
        return mass / mass.sum(axis=1, keepdims=True)
    if form in (PROPORTION, DIRICHLET):
        return prior.probs(codes, form, generator=generator)
    return prior.probs(codes, "softmax", beta=1.0 if form == AS_PRINTED else 1.0 / policies)


def summary(rewards: NDArray[np.float64], early: int) -> dict:
    """A run's numbers from (n_tasks, n_episodes) rewards: means of all and of the first `early` episodes.

    `spread_early` is the standard deviation of an episode's reward across tasks, a mean over the early episodes.
    """
    first = rewards[:, :early]
    spread = float(first.std(axis=0, ddof=1).mean())
    return {"early": float(first.mean()), "all": float(rewards.mean()), "spread_early": spread}
