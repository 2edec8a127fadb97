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
from lifelore.core.learning.q_learning import Rows, Schedule
from lifelore.core.mdp import Tables
from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate, ratio_estimate
from lifelore.core.planning.planning import best_actions, mean_start_value, optimal_q
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.grid import combinations
from reproduction.engine.learning_run import curves_of
from reproduction.engine.records import in_blocks

STATE, PLACE, PERCEPT = "state", "place", "percept"
"""What a prior may be conditioned on; a place is row and column, the same number in every world of a size."""
CHOICES = ("schedule", "ties", "form", "alpha0")
"""Settings with the values of the choices that the thesis leaves open; a reading has a value of each."""
PLAIN = "q_learning"
WINDOW = 10
"""Episodes of the moving mean that must reach a percentage of the optimum."""


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


class Trained(NamedTuple):
    """A prior's `kind` (`STATE`, `PLACE` or `PERCEPT`) and the problems whose policies make it."""

    kind: str
    problems: Sequence[Problem]


def problem_of(world: GridWorld, goal: int, names: tuple) -> Problem:
    """The task of reaching `goal`, solved; `names` of its streams."""
    tables = world.task(goal).tables()
    q = optimal_q(tables, world.discount)
    best = best_actions(q)
    best[goal] = False  # every action ties at the goal: nothing was chosen there
    place = world.cells.astype(np.int64) @ np.array([world.shape[1], 1])
    contexts = {STATE: np.arange(world.n_states), PLACE: place, PERCEPT: world.percepts}
    return Problem(goal, tables, names, q.max(axis=1), best, contexts)


def choices_of(settings: Mapping) -> list[dict]:
    """Every combination of the choices left open, `CHOICES`; the first values make the default."""
    return combinations(settings, CHOICES)


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
        return prior.probs(codes, form, generator=random)

    return prior_rows(problem.tables, problem.contexts[kind], probs_of, ties)


def returns_of(
    problems: Sequence[Problem], rows_for: Callable[[Problem], Rows | None], schedule: Schedule
) -> NDArray[np.float64]:
    """Learning curves of problems, (n_problems, n_episodes)."""
    return np.array([curve.returns for curve in curves_of(problems, rows_for, schedule)])


def drawn_starts(tables: Tables, names: tuple, n_episodes: int) -> list[int]:
    """Where each episode starts; the stream that `names` give the world draws nothing else."""
    random = random_state(stream(*names, "world"))
    return [int(tables.starts[int(next_uniform(random) * tables.starts.size)]) for _ in range(n_episodes)]


def start_values(problem: Problem, n_episodes: int) -> NDArray[np.float64]:
    """The best return from where each episode of `learnt` starts, (n_episodes,).

    Episodes start at random, near the goal or far from it. Measured against the best from the same starts, a
    lucky stretch of starts does not pass for learning.
    """
    return problem.values[drawn_starts(problem.tables, problem.stream, n_episodes)]


def summary(returns: NDArray[np.float64], best: NDArray[np.float64]) -> dict:
    """A run's numbers from its mean curve and the best it could have been, both (n_episodes,).

    Percent of optimal are of the best from the same starts, over a moving window of episodes; a run that never
    reaches them enters at the cap.
    """
    episodes = len(returns)
    found = {"first": float(returns[0]), "first_ten": float(returns[:10].mean()), "mean": float(returns.mean())}
    for percent in (50, 80):
        reached = episodes_to_threshold(returns - percent / 100 * best, 0.0, min(WINDOW, episodes))
        found[f"to_{percent}"] = episodes if reached is None else reached
    return found


def learnt_by_choice(
    settings: Mapping, testing: Sequence[Problem], trained: Mapping[str, Trained], number: int
) -> dict:
    """Numbers of Q-learning (`PLAIN`) and of learners with each prior, a list over the choices left open.

    Runs from ``reading_runs`` on have the default alone; run 0 also has its curves at the default.
    """
    choices = choices_of(settings)
    best = np.mean([start_values(p, settings["episodes"]) for p in testing], axis=0)
    found, plain, curves = [], {}, {}
    for choice in choices if number < settings["reading_runs"] else choices[:1]:
        schedule, key = schedule_of(settings, choice["schedule"]), str(choice["schedule"])
        if key not in plain:
            plain[key] = returns_of(testing, lambda _: None, schedule)
        returns = {PLAIN: plain[key]}
        for name, one in trained.items():
            returns[name] = _returns_with(testing, one, choice, schedule)
        if not curves:
            curves = {name: block_curve(in_blocks(r), settings["episodes"]) for name, r in returns.items()}
        found.append({name: summary(r.mean(axis=0), best) for name, r in returns.items()})
    optimal = float(np.mean([mean_start_value(p.tables, p.values) for p in testing]))
    return {"optimal": optimal, "choices": found, "curves": curves if number == 0 else {}}


def _returns_with(
    testing: Sequence[Problem], trained: Trained, choice: Mapping, schedule: Schedule
) -> NDArray[np.float64]:
    kind, prior = trained.kind, exact_prior(trained.problems, choice["alpha0"], trained.kind)
    return returns_of(testing, lambda p: rows_of(p, prior, choice["form"], choice["ties"], kind), schedule)


def block_curve(blocks: NDArray[np.float64], n_episodes: int) -> dict[str, list[float]]:
    """Mean and deviation over tasks of `in_blocks` (n_tasks, n_blocks), at their middle episodes `x`."""
    x = in_blocks(np.arange(1.0, n_episodes + 1)[None])[0]
    numbers = {"x": x, "mean": blocks.mean(axis=0), "deviation": blocks.std(axis=0)}
    return {name: np.round(of_blocks, 2).tolist() for name, of_blocks in numbers.items()}


def compared(results: Sequence[Mapping], place: int, ours: str, theirs: str) -> dict[str, Estimate]:
    """A learner against another at a choice, paired by run: returns as differences, episodes as ratios."""
    runs = [result["choices"][place] for result in results if place < len(result["choices"])]

    def pair(measure: str) -> tuple[list[float], list[float]]:
        return [run[ours][measure] for run in runs], [run[theirs][measure] for run in runs]

    return {
        "first_gain": difference_estimate(*pair("first")),
        "mean_gain": difference_estimate(*pair("mean")),
        "to_50_ratio": ratio_estimate(*pair("to_50")),
        "to_80_ratio": ratio_estimate(*pair("to_80")),
    }


def at_default(results: Sequence[Mapping], measure: str, name: str) -> Estimate:
    """A learner's number at the default."""
    return mean_estimate([result["choices"][0][name][measure] for result in results])


def curve_rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """What the figure draws: the curves of run 0."""
    return [{"curve_of": name, **curve} for result in results for name, curve in result["curves"].items()]
