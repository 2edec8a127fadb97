"""C3.11: one prior as proportions, as draws from a Dirichlet and as softmaxes, in modified factories.

A run draws factories and lists of components for training and others for testing. The exact policies of the
training tasks, pooled by observation, make the prior; every form meets the same tasks and random numbers. The
thesis prints the softmax of the counts U. An observation pools the counts of all states that share it, which makes
hundreds of them, and the thesis names no normalisation: U is also divided by the number of policies, and the
softmax is also taken of the proportions, times a scale. An optimal episode's moves cost about what its task pays,
so that its reward lies near 0; the scale of *comparable* is the distance from learning without a prior to the
optimum. Thesis: §3.2.2.1, §3.4.7, Figure 3.15.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import prior_rows
from lifelore.core.learning.q_learning import Rows
from lifelore.core.streams import stream
from lifelore.experiments.chapter3.factory.modified_tasks import (
    N_ACTIONS,
    Problem,
    contexts_of,
    learn_problem,
    problem_of,
)
from lifelore.experiments.chapter3.learning.schedules import schedule_of
from lifelore.experiments.engine.grid import Grid, run_grid

WITHOUT_PRIOR, PROPORTION, DIRICHLET, AS_PRINTED = "uniform", "proportion", "dirichlet", "softmax of counts"
SCALE = {"softmax of proportions": 1.0, "softmax of 10 × proportions": 10.0}
FORMS = (PROPORTION, DIRICHLET, AS_PRINTED, "softmax of counts a policy", *SCALE)
SOFTMAXES = FORMS[2:]
KEYS = ("features", "schedule", "ties", "alpha0", "max_steps", "policies")


class Run(NamedTuple):
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
        schedule = schedule_of({**settings, "max_steps": how["max_steps"]}, how["schedule"])
        rows_for = rows_maker(run, form, how)
        rewards = np.array(
            [learn_problem(problem, rows_for(problem), schedule)[0].rewards for problem in run.testing]
        )
        found = summary(rewards, settings["early"])
        if grid.is_default_but_for_schedule(how):
            found |= {"mean": rewards.mean(axis=0).tolist(), "deviation": rewards.std(axis=0, ddof=1).tolist()}
        return found

    optimal = float(np.mean([problem.optimal for problem in run.testing]))
    return {**cell, "optimal": optimal, "found": list(run_grid(grid, "form", WITHOUT_PRIOR, FORMS, numbers))}


def run_of(settings: Mapping, seed: int, number: int) -> Run:
    """Run `number`; more training or test tasks leave the first ones as they are."""
    own = (seed, "C3.11", number)
    counting = {name: ActionPrior(N_ACTIONS, 1.0, name) for name in settings["features"]}
    priors = {}
    for i in range(max(settings["policies"])):
        problem = problem_of(settings, (*own, "training", i))
        for name, prior in counting.items():
            prior.update(contexts_of(problem, name), problem.best)
            if i + 1 in settings["policies"]:
                priors[name, i + 1] = ActionPrior.merged([prior])
    return Run(priors, [problem_of(settings, (*own, "testing", i)) for i in range(settings["test_tasks"])])


def rows_maker(run: Run, form: str, how: Mapping):
    """The function from a problem to the rows of a form in a cell of the grid; None without a prior."""
    if form == WITHOUT_PRIOR:
        return lambda problem: None
    counts = run.priors[how["features"], how["policies"]].fixed_point_counts()
    prior = ActionPrior.from_fixed_point_counts(*counts, how["alpha0"])
    return lambda problem: rows_of(problem, prior, form, how)


def rows_of(problem: Problem, prior: ActionPrior, form: str, how: Mapping) -> Rows:
    """Rows of ε-QPAP; a Dirichlet is drawn from once for the task."""
    random = stream(*problem.stream, "dirichlet")

    def probs(codes):
        return probs_of(prior, codes, form, how["policies"], random)

    return prior_rows(problem.tables, contexts_of(problem, how["features"]), probs, how["ties"])


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
