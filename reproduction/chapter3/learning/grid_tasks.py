"""Tasks of lattices and noise mazes with their exact solutions, priors from these, and learning with them.

Everything that is compared within a run meets the same goals, starts and random numbers, so differences between
methods are paired. Thesis: §3.4.1, Alg. 2 and 4.
"""

from collections.abc import Callable, Mapping, Sequence
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
from reproduction.engine.learning_run import learnt

STATE, PLACE, PERCEPT = "state", "place", "percept"
"""What a prior may be conditioned on; a place is row and column, the same number in every world of a size."""
ESCAPE = 0.02
"""Mass that the form ``support`` spreads over all actions."""
READ_ALPHA0 = ("proportion", "dirichlet", "tempered")
"""Forms that α⁰ enters; the others are measured once, with α⁰ None."""


class Problem(NamedTuple):
    """A task as learners meet it.

    stream : names of its streams
    values, best : (n_states,) float and (n_states, 4) bool, exact values and best actions, none at the goal
    contexts : codes (n_states,) by `STATE`, `PLACE` and `PERCEPT`
    """

    goal: int
    tables: Tables
    stream: tuple
    values: NDArray[np.float64]
    best: NDArray[np.bool_]
    contexts: dict[str, NDArray[np.int64]]


class Tasks(NamedTuple):
    """The tasks of a run by the world they lie in: those whose policies make the prior, and those learnt."""

    training: dict[str, list[Problem]]
    testing: list[Problem]


def problem_of(world: GridWorld, goal: int, names: tuple) -> Problem:
    """The task of reaching `goal`, solved; `names` of its streams."""
    tables = world.task(goal).tables()
    q = optimal_q(tables, world.discount)
    best = best_actions(q)
    best[goal] = False  # every action ties at the goal: nothing was chosen there
    place = world.cells.astype(np.int64) @ np.array([world.shape[1], 1])
    contexts = {STATE: np.arange(world.n_states), PLACE: place, PERCEPT: world.percepts}
    return Problem(goal, tables, names, q.max(axis=1), best, contexts)


def prior_choices(settings: Mapping) -> list[dict]:
    """Uses of a prior: form × α⁰ × ties; α⁰ is None where the form does not read it."""
    return [
        {"ties": ties, "alpha0": alpha0, "form": form}
        for form in settings["forms"]
        for alpha0 in (settings["alpha0"] if form in READ_ALPHA0 else [None])
        for ties in settings["ties"]
    ]


def exact_prior(problems: Sequence[Problem], alpha0: float, kind: str = STATE) -> ActionPrior:
    """The prior from exact optimal policies, tied actions counted (Eq. 3.1, 3.5, 3.7)."""
    prior = ActionPrior(4, alpha0)
    for problem in problems:
        prior.update(problem.contexts[kind], problem.best)
    return prior


def rows_of(problem: Problem, prior: ActionPrior, form: str, ties: str, kind: str = STATE) -> Rows:
    """Rows of ε-QSAP or ε-QPAP; ``dirichlet`` draws θ once for the task, as the algorithms require."""
    random = stream(*problem.stream, "dirichlet")

    def probs_of(codes):
        return prior.probs(codes, form, generator=random, escape=ESCAPE)

    return prior_rows(problem.tables, problem.contexts[kind], probs_of, ties)


def learn_task(problem: Problem, rows: Rows | None, schedule: Schedule) -> tuple[NDArray[np.float64], QLearner]:
    """Returns (n_episodes,) and the learner after all episodes; without `rows` it is plain Q-learning."""
    curve, learner = learnt(problem.tables, problem.stream, rows, schedule)
    return curve.returns, learner


def mean_returns(
    problems: Sequence[Problem], rows_for: Callable[[Problem], Rows | None], schedule: Schedule
) -> NDArray[np.float64]:
    """Mean learning curve over problems, (n_episodes,)."""
    return np.mean([learn_task(p, rows_for(p), schedule)[0] for p in problems], axis=0)


def drawn_starts(tables: Tables, names: tuple, n_episodes: int) -> list[int]:
    """Where each episode starts; the stream that `names` give the world draws nothing else."""
    random = random_state(stream(*names, "world"))
    return [int(tables.starts[int(next_uniform(random) * tables.starts.size)]) for _ in range(n_episodes)]


def start_values(problem: Problem, n_episodes: int) -> NDArray[np.float64]:
    """The best return from where each episode of `learn_task` starts, (n_episodes,).

    Episodes start at random, near the goal or far from it. Measured against the best from the same starts, a
    lucky stretch of starts does not pass for learning.
    """
    return problem.values[drawn_starts(problem.tables, problem.stream, n_episodes)]


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
