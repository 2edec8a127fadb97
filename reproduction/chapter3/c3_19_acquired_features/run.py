"""Cells of C3.19: agents of each start and least bits meet the same tasks; then learners use their priors.

Every prior counts the exact optimal policies of the same training tasks, in all states alike. The noise has a
value of its own in every state of every task. Thesis: §3.3.2.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.features.feature_acquisition import AcquisitionSettings, FeatureAcquisition
from lifelore.action.features.feature_set import FeatureSet
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import prior_rows
from lifelore.core.streams import stream
from lifelore.domains.factory.contexts import PHI
from lifelore.domains.factory.factory import ACTION_NAMES
from reproduction.chapter3.factory.modified_tasks import FULL_SET, Problem, problem_of, rewards_of
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.grid import Grid, run_grid

PLAIN, START, ACQUIRED, ALL = "uniform", "start", "acquired", "all"
METHODS = (START, ACQUIRED, ALL)
KEYS = ("start", "least")
STARTS = {"phi1": PHI["phi1"], "items": ("Items",), "north": ("PosUM", "Items")}
"""Features at the start: the own cell and Items; Items alone; the cell to the North and Items."""
NOISE = ("Noise1", "Noise2")
NOISE_SIZES = (4, 3)
POOL = FeatureSet((*FULL_SET.names, *NOISE), (*FULL_SET.sizes, *NOISE_SIZES))


class Counted(NamedTuple):
    """A task and the codes of all its states in `POOL`, (n_states,)."""

    problem: Problem
    codes: NDArray[np.int64]


def grid_of(settings: Mapping) -> Grid:
    """The grid: starts × least bits."""
    crossed = {"start": "starts", "least": "leasts"}
    return Grid.crossed(settings, KEYS, crossed, reads={PLAIN: (), START: ("start",), ALL: ()})


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: every agent's features, and each method's entropy, surprise and rewards in new tasks."""
    own, grid = (seed, "C3.19", cell["run"]), grid_of(settings)
    order = stream(*own, "order").permutation(POOL.names).tolist()
    agents = {grid.key(choice): _agent(settings, choice, order) for choice in grid.cells}
    fixed = {name: ActionPrior(len(ACTION_NAMES), settings["alpha0"]) for name in (*settings["starts"], ALL)}
    names_of = {**STARTS, ALL: FULL_SET.names}
    for i in range(settings["tasks"]):
        task = counted_task(settings, (*own, "training", i))
        for agent in agents.values():
            agent.update(task.codes, task.problem.best)
        for name, prior in fixed.items():
            prior.update(POOL.coarser(task.codes, names_of[name]), task.problem.best)
    testing = [counted_task(settings, (*own, "testing", i)) for i in range(settings["test_tasks"])]

    def numbers(method: str, choice: Mapping) -> dict:
        if method == ACQUIRED:
            agent = agents[grid.key(choice)]
            found = _numbers(settings, testing, agent.prior, agent.chosen.names)
            return found | {"features": list(agent.chosen.names), "trials": len(agent.trials)}
        if method == PLAIN:
            return _numbers(settings, testing, None, ())
        name = ALL if method == ALL else choice["start"]
        return _numbers(settings, testing, fixed[name], names_of[name])

    optimal = float(np.mean([task.problem.optimal for task in testing]))
    return {**cell, "optimal": optimal, "found": list(run_grid(grid, "method", PLAIN, METHODS, numbers))}


def counted_task(settings: Mapping, names: tuple) -> Counted:
    """The task that the streams of `names` draw, and the codes of its states with noise."""
    problem = problem_of(settings, names)
    noise = stream(*names, "noise").integers(0, NOISE_SIZES, (len(problem.seen), len(NOISE)))
    return Counted(problem, POOL.codes(np.column_stack([problem.seen, noise])))


def _agent(settings: Mapping, choice: Mapping, order: list[str]) -> FeatureAcquisition:
    start = STARTS[choice["start"]]
    return FeatureAcquisition(
        POOL,
        start,
        ACTION_NAMES,
        [name for name in order if name not in start],
        AcquisitionSettings(least=choice["least"]),
        settings["alpha0"],
    )


def _numbers(settings: Mapping, testing: list[Counted], prior: ActionPrior | None, names: tuple[str, ...]) -> dict:
    """Mean entropy of the prior and surprise at best actions in states of new tasks, bits; mean rewards."""
    schedule = schedule_of(settings, settings["schedule"])
    codes = {id(task.problem): POOL.coarser(task.codes, names) for task in testing}

    def rows_for(problem: Problem):
        if prior is None:
            return None
        return prior_rows(problem.tables, codes[id(problem)], prior.probs, settings["ties"])

    rewards = rewards_of([task.problem for task in testing], rows_for, schedule)
    found: dict = {"all": float(rewards.mean()), "mean": np.round(rewards.mean(axis=0), 2).tolist()}
    if prior is not None:
        parts = [doubt(prior.probs(codes[id(task.problem)]), task.problem.best) for task in testing]
        found["entropy"], found["surprise"] = np.mean(parts, axis=0).tolist()
    return found


def doubt(probs: NDArray[np.float64], best: NDArray[np.bool_]) -> tuple[float, float]:
    """Mean entropy of rows, and mean surprise at their best actions, ties alike; bits, over states with one.

    Parameters
    ----------
    probs : (n_states, n_actions) float64
        Rows are positive and sum to 1.
    best : (n_states, n_actions) bool
    """
    some = best.any(axis=1)
    bits = -np.log2(probs[some])
    share = best[some] / best[some].sum(axis=1, keepdims=True)
    return float((probs[some] * bits).sum(axis=1).mean()), float((share * bits).sum(axis=1).mean())
