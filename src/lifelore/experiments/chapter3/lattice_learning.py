"""Learners on the lattice, with and without a prior, on streams that they share.

A run is one set of training tasks, whose policies make the prior, and one set of test tasks. Everything that
is compared within a run meets the same goals, the same starts and the same random numbers of its own, so
differences between methods are paired. Thesis: §3.4.1, Alg. 2.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import prior_rows
from lifelore.core.compiled.random_state import next_uniform, random_state
from lifelore.core.learning.learning_metrics import episodes_to_threshold
from lifelore.core.learning.q_learning import QLearner, Rows, Schedule
from lifelore.core.mdp import Tables
from lifelore.core.planning.planning import best_actions, optimal_q
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.grids.lattice import lattice
from lifelore.experiments.engine.learning_run import learnt

ESCAPE = 0.02
"""Mass that the form ``support`` spreads over all actions."""


class Problem(NamedTuple):
    """One task as learners meet it: tables, names of its streams, exact values and best actions by state."""

    goal: int
    tables: Tables
    stream: tuple
    values: NDArray[np.float64]
    best: NDArray[np.bool_]


class Run(NamedTuple):
    """A world with training and test problems."""

    world: GridWorld
    training: list[Problem]
    testing: list[Problem]


def run_of(settings: Mapping, seed: int, number: int) -> Run:
    """Run `number`: goals are drawn without repeats, for training and for testing apart."""
    world = lattice(settings["size"], settings["discount"])
    most = max(settings["training_tasks"], *settings["online_tasks"])
    names = {"training": most, "testing": settings["test_tasks"]}
    problems = {}
    for name, n_tasks in names.items():
        drawn = stream(seed, "C3.2", number, name).permutation(world.n_states)[:n_tasks]
        problems[name] = [_problem(world, int(g), (seed, "C3.2", number, name, i)) for i, g in enumerate(drawn)]
    return Run(world, problems["training"], problems["testing"])


def _problem(world: GridWorld, goal: int, stream_of: tuple) -> Problem:
    tables = world.task(goal).tables()
    q = optimal_q(tables, world.discount)
    best = best_actions(q)
    best[goal] = False  # every action ties at the goal: nothing was chosen there
    return Problem(goal, tables, stream_of, q.max(axis=1), best)


def exact_prior(problems: Sequence[Problem], alpha0: float) -> ActionPrior:
    """The prior from exact optimal policies, tied actions counted (Eq. 3.1, 3.5)."""
    prior = ActionPrior(4, alpha0)
    for problem in problems:
        prior.update(np.arange(len(problem.best)), problem.best)
    return prior


def rows_of(problem: Problem, prior: ActionPrior, form: str, ties: str) -> Rows:
    """ε-QSAP's rows; ``dirichlet`` draws θ once for the task, as Alg. 2 requires it before learning."""
    random = stream(*problem.stream, "dirichlet")

    def probs_of(codes):
        return prior.probs(codes, form, generator=random, escape=ESCAPE)

    return prior_rows(problem.tables, np.arange(problem.tables.n_states), probs_of, ties)


def schedule_of(settings: Mapping, epsilon: Sequence[float]) -> Schedule:
    """ε starts at the first of three numbers, falls by the second each episode, to the third at the least."""
    first, decay, floor = epsilon
    n_episodes = settings["episodes"]
    fall = np.maximum(first * decay ** np.arange(n_episodes), floor)
    alpha = np.full(n_episodes, settings["learning_rate"])
    return Schedule(fall, alpha, settings["max_steps"], settings["discount"])


def learn_task(problem: Problem, rows: Rows | None, schedule: Schedule) -> tuple[NDArray[np.float64], QLearner]:
    """Returns (n_episodes,) and the learner after all episodes; without `rows` it is plain Q-learning."""
    curve, learner = learnt(problem.tables, problem.stream, rows, schedule)
    return curve.returns, learner


def mean_returns(problems: Sequence[Problem], rows_for, schedule: Schedule) -> NDArray[np.float64]:
    """Mean learning curve over problems, (n_episodes,); `rows_for(problem)` gives rows or None."""
    return np.mean([learn_task(p, rows_for(p), schedule)[0] for p in problems], axis=0)


def start_values(problem: Problem, n_episodes: int) -> NDArray[np.float64]:
    """The best return from where each episode of `learn_task` starts, (n_episodes,).

    Episodes start at random, near the goal or far from it. Measured against the best from the same starts, a
    lucky stretch of starts does not pass for learning. The world's stream gives nothing but starts here.
    """
    random = random_state(stream(*problem.stream, "world"))
    starts = problem.tables.starts
    drawn = [starts[int(next_uniform(random) * starts.size)] for _ in range(n_episodes)]
    return problem.values[drawn]


def summary(settings: Mapping, returns: NDArray[np.float64], best: NDArray[np.float64]) -> dict:
    """A run's numbers from its mean curve and the best it could have been, both (n_episodes,).

    Percent of optimal are of the best from the same starts, over a moving window of episodes; a run that never
    reaches them enters at the cap.
    """
    found = {"first": float(returns[0]), "first_ten": float(returns[:10].mean())}
    for percent in (50, 80):
        reached = episodes_to_threshold(returns - percent / 100 * best, 0.0, settings["window"])
        found[f"to_{percent}"] = settings["episodes"] if reached is None else reached
        found[f"never_{percent}"] = reached is None
    last = settings["last"]
    found["final"] = float(returns[-last:].sum() / best[-last:].sum())
    return found
