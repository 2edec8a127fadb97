"""C3.4: learnt and hand-made priors in the factory.

Thesis: §3.4.3, Figure 3.7.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.core.streams import stream
from lifelore.figures.style import BLUE, GREEN, GREY, VERMILION, Figure, new_figure
from reproduction.chapter3.c3_04_factory_priors.knowledge import expert_actions, incorrect_actions, invariances
from reproduction.chapter3.factory import comparison, learning
from reproduction.chapter3.factory.comparison import UNIFORM, Comparison, is_default, summary
from reproduction.chapter3.factory.figure import caption, draw_rewards
from reproduction.chapter3.factory.learning import LEARNT, N_ACTIONS, Problem, contexts_of
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.grid import Cell, Grid, run_grid
from reproduction.engine.learning_run import learnt

ADVICE = {"expert": expert_actions, "incorrect": incorrect_actions}
"""Actions that a person advises, by name of the hand-made prior."""
METHODS = (UNIFORM, LEARNT, *ADVICE)
PAIRS = {
    "learnt_minus_expert": (LEARNT, "expert", "early"),
    "learnt_minus_uniform": (LEARNT, UNIFORM, "early"),
    "expert_minus_incorrect": ("expert", "incorrect", "early"),
    "incorrect_minus_uniform": ("incorrect", UNIFORM, "early"),
}


def grid_of(settings: Mapping) -> Grid:
    """The grid; the hand-made priors do not read the code of states."""
    keys = ("encoding", "schedule", "max_steps", "ties", "alpha0", "episodes")
    return comparison.grid_of(settings, keys[:3], keys[3:], dict.fromkeys(ADVICE, keys[1:]))


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: training tasks, and one test task learnt with every prior in every cell of the grid."""
    run, k, grid = cell["run"], settings["components"], grid_of(settings)
    training = learning.tasks_of(settings, seed, k, run, settings["training_tasks"])
    components = learning.floor(settings["discount"]).draw_components(stream(seed, "factory", k, run, "test"), k)
    problem = learning.problem_of(settings, components, (seed, "factory", k, run, "test"))
    priors = _priors(settings, training, problem)

    def numbers(method: str, how: Cell) -> dict:
        rows = None
        if method != UNIFORM:
            prior = learning.with_pseudo_count(priors[how["encoding"] or method], how["alpha0"])
            rows = learning.rows_of(problem, how["encoding"], prior.probs, how["ties"])
        schedule = schedule_of({**settings, **how}, how["schedule"])
        curve, learner = learnt(problem.tables, problem.stream, rows, schedule)
        found = summary([curve], settings["early"], is_default(grid, how, but=["max_steps"]))
        return {**found, "solution": learning.greedy_return(problem, learner.q)}

    return {
        **cell,
        "optimal": problem.optimal,
        "optimal_return": problem.optimal_return,
        "invariances": least_invariance(problem, priors[grid.default["encoding"]], grid.default),
        "found": list(run_grid(grid, METHODS, numbers)),
    }


def _priors(settings: Mapping, training: list[tuple[int, ...]], problem: Problem) -> dict[str, ActionPrior]:
    """Learnt priors by encoding, and hand-made ones, which count as much as the training tasks."""
    known = [learning.solved(components, settings["discount"]) for components in training]
    found = {encoding: learning.exact_prior(known, encoding, 1.0) for encoding in settings["encoding"]}
    for name, advice_of in ADVICE.items():
        found[name] = learning.hand_made_prior(advice_of(problem.task), len(training), 1.0)
    return found


def least_invariance(problem: Problem, prior: ActionPrior, default: Mapping) -> float:
    """The least, over the five invariances, by which the prior's mass beats a uniform one's on the right side."""
    contexts = contexts_of(problem, default["encoding"])
    probs = learning.with_pseudo_count(prior, default["alpha0"]).probs(contexts)
    even = np.full_like(probs, 1 / N_ACTIONS)
    held = invariances(problem.task).values()
    return min((1 if one.wanted else -1) * (one.mass(probs) - one.mass(even)) for one in held)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """How much the prior holds the invariances at the default, and the optimal reward."""
    return {
        "least_invariance": mean_estimate([result["invariances"] for result in results]),
        "optimal_reward": mean_estimate([result["optimal"] for result in results]),
    }


def _numbers(found: Comparison, cell: Mapping) -> dict[str, Estimate]:
    """Early rewards compared, and the policy learnt with the incorrect prior as a share of the optimal return."""
    if not found.is_own(cell, "incorrect"):
        return found.shares(cell, PAIRS)
    optimal = np.array([result["optimal_return"] for result in found.results])
    incorrect, uniform = (found.values(method, cell, "solution") for method in ("incorrect", UNIFORM))
    return {
        **found.shares(cell, PAIRS),
        "recovery": ratio_estimate(incorrect - uniform, optimal),
        "solution_incorrect": ratio_estimate(incorrect, optimal),
    }


_, readings, _ = comparison.functions_of(grid_of, METHODS, _numbers)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The curve of each method at the default and under the other caps."""
    found = Comparison(results, grid_of(settings))
    return [
        {"max_steps": cap, **found.curve(method, {**found.grid.default, "max_steps": cap})}
        for cap in settings["max_steps"]
        for method in METHODS
    ]


LOOKS = {
    "uniform": ("uniform prior", GREY),
    "learnt": ("learnt prior", BLUE),
    "expert": ("expert prior", GREEN),
    "incorrect": ("incorrect prior", VERMILION),
}


def draw(result: Mapping) -> Figure:
    """Figure of claim C3.4: learning with each prior, episodes to their end and cut off.

    A panel for the default, and one for the first other cap of an episode's steps.
    """
    settings = result["settings"]
    caps = settings["max_steps"][:2]
    figure = new_figure(4.9 * len(caps), 4.0)
    for axes, cap in zip(figure.subplots(1, len(caps), squeeze=False)[0], caps, strict=True):
        rows = [row for row in result["rows"] if row["max_steps"] == cap]
        draw_rewards(axes, result, rows, LOOKS, settings["episodes"][0], f"episodes of at most {cap:,} steps")
        axes.legend(loc="lower right")
    figure.supxlabel(f"{caption(settings)}.", fontsize=8, color=GREY)
    return figure
