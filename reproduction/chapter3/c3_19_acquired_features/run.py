"""C3.19: agents that acquire features while the entropy of the prior stays high, and learners with their priors.

The thesis proposes it and gives no procedure: this one is ours. Agents begin with few of the ten features of φ4.
A new one is recorded over two tasks, in random order, and kept where the counts of these tasks have ``least`` bits
less entropy with it. Two candidates are noise, with a value of its own in every state of every task. Every prior
counts the exact optimal policies of the same training tasks, in all states alike. Thesis: §3.3.2.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.features.feature_acquisition import AcquisitionSettings, FeatureAcquisition
from lifelore.action.features.feature_set import FeatureSet
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import prior_rows
from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate, ratio_estimate
from lifelore.core.streams import stream
from lifelore.domains.factory.contexts import PHI
from lifelore.domains.factory.factory import ACTION_NAMES
from reproduction.chapter3.factory.learning import Problem
from reproduction.chapter3.factory.modified_tasks import CARDINALS, FULL_SET, problem_of
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.estimates import exact_share
from reproduction.engine.grid import combinations
from reproduction.engine.learning_run import curves_of

PLAIN, START, ACQUIRED, ALL = METHODS = ("uniform", "start", "acquired", "all")
STARTS = {"phi1": PHI["phi1"], "items": ("Items",), "north": ("PosUM", "Items")}
"""Features at the start: the own cell and Items; Items alone; the cell to the North and Items."""
NOISE = ("Noise1", "Noise2")
NOISE_SIZES = (4, 3)
POOL = FeatureSet((*FULL_SET.names, *NOISE), (*FULL_SET.sizes, *NOISE_SIZES))
ALPHA0 = 0.1
CHOICES = ("start", "least")


class Counted(NamedTuple):
    """A task and the codes of all its states in `POOL`, (n_states,)."""

    problem: Problem
    codes: NDArray[np.int64]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: features acquired, and entropy, surprise and rewards in new tasks, by choice."""
    own, choices = (seed, "C3.19", cell["run"]), combinations(settings, CHOICES)
    order = stream(*own, "order").permutation(POOL.names).tolist()
    agents = [_agent(choice, order) for choice in choices]
    names_of = {**{start: STARTS[start] for start in settings["start"]}, ALL: FULL_SET.names}
    fixed = {name: ActionPrior(len(ACTION_NAMES), ALPHA0) for name in names_of}
    for i in range(settings["tasks"]):
        task = counted_task(settings, (*own, "training", i))
        for agent in agents:
            agent.update(task.codes, task.problem.best)
        for name, prior in fixed.items():
            prior.update(POOL.coarser(task.codes, names_of[name]), task.problem.best)
    testing = [counted_task(settings, (*own, "testing", i)) for i in range(settings["test_tasks"])]

    def numbers(prior: ActionPrior | None, names: Sequence[str]) -> dict:
        return _numbers(settings, testing, prior, tuple(names))

    of_fixed = {name: numbers(prior, names_of[name]) for name, prior in fixed.items()}
    of_agents = [numbers(agent.prior, agent.chosen.names) for agent in agents]
    return {
        **cell,
        "optimal": float(np.mean([task.problem.optimal for task in testing])),
        PLAIN: numbers(None, ()),
        ALL: of_fixed[ALL],
        START: [of_fixed[choice["start"]] for choice in choices],
        ACQUIRED: of_agents,
        "features": [list(agent.chosen.names) for agent in agents],
    }


def counted_task(settings: Mapping, names: tuple) -> Counted:
    """The task that the streams of `names` draw, and the codes of its states with noise."""
    problem = problem_of(settings, names)
    noise = stream(*names, "noise").integers(0, NOISE_SIZES, (len(problem.seen), len(NOISE)))
    return Counted(problem, POOL.codes(np.column_stack([problem.seen, noise])))


def _agent(choice: Mapping, order: list[str]) -> FeatureAcquisition:
    start = STARTS[choice["start"]]
    new = [name for name in order if name not in start]
    return FeatureAcquisition(POOL, start, ACTION_NAMES, new, AcquisitionSettings(least=choice["least"]), ALPHA0)


def _numbers(settings: Mapping, testing: list[Counted], prior: ActionPrior | None, names: tuple[str, ...]) -> dict:
    """Mean entropy of the prior and surprise at best actions in states of new tasks, bits; rewards by episode."""
    codes = {id(task.problem): POOL.coarser(task.codes, names) for task in testing}

    def rows_for(problem: Problem):
        return None if prior is None else prior_rows(problem.tables, codes[id(problem)], prior.probs)

    schedule = schedule_of(settings, settings["schedule"])
    curves = curves_of([task.problem for task in testing], rows_for, schedule)
    found: dict = {"rewards": np.round(np.mean([curve.rewards for curve in curves], axis=0), 1).tolist()}
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


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """At the default: which features are acquired, and rewards with them."""
    shares = acquired_shares(results)
    acquired, every, plain = (
        np.array([np.mean(of_run["rewards"]) for of_run in found])
        for found in ([r[ACQUIRED][0] for r in results], [r[ALL] for r in results], [r[PLAIN] for r in results])
    )
    optimal = np.array([result["optimal"] for result in results])
    return {
        "least_share_of_four": min((shares[name] for name in CARDINALS), key=lambda share: share.value),
        "largest_share_of_noise": max((shares[name] for name in NOISE), key=lambda share: share.value),
        "acquired_minus_all": ratio_estimate(acquired - every, optimal - plain),
        "optimal_reward": mean_estimate(optimal),
    }


def _gains(results: Sequence[Mapping], place: int) -> dict[str, Estimate]:
    """Acquired features against those at the start, paired by run."""

    def both(number: Callable[[Mapping], float]) -> tuple[list[float], list[float]]:
        return [number(r[START][place]) for r in results], [number(r[ACQUIRED][place]) for r in results]

    start, acquired = both(lambda found: float(np.mean(found["rewards"])))
    return {
        "entropy_fall": difference_estimate(*both(lambda found: found["entropy"])),
        "surprise_fall": difference_estimate(*both(lambda found: found["surprise"])),
        "reward_gain": difference_estimate(acquired, start),
    }


def acquired_shares(results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The share of runs that have each feature at the end, at the default."""
    return {name: exact_share(name in result["features"][0] for result in results) for name in POOL.names}


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """Entropy, surprise and rewards with acquired features, by start and least bits."""
    for place, choice in enumerate(combinations(settings, CHOICES)):
        yield choice, _gains(results, place)
