"""C3.2: Q-learning on the lattice with a prior from other tasks' policies, and with a prior made task by task.

The thesis prints neither ties nor α⁰ nor how the prior is used in exploration: readings cross these with ε. Its
figure is of 10 tasks, which are a run here; numbers are over many runs. Thesis: §3.4.1, Figure 3.3.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.learning.q_learning import Schedule
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.core.planning.planning import learnt_best_actions
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.grids.lattice import lattice
from reproduction.chapter3.figures.return_curves import draw_return_curves
from reproduction.chapter3.learning import grid_tasks
from reproduction.chapter3.learning.grid_tasks import PLAIN, STATE, Problem, Trained
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.learning_run import learnt

PRIOR = "eps_qsap"
rows = grid_tasks.curve_rows


class Tasks(NamedTuple):
    """A lattice with the tasks whose policies make the prior, and those that are learnt."""

    world: GridWorld
    training: list[Problem]
    testing: list[Problem]


def run_of(settings: Mapping, seed: int, number: int) -> Tasks:
    """Run `number`: goals are drawn without repeats, for training and for testing apart."""
    world = lattice(settings["size"], settings["discount"])
    tasks = []
    for name in ("training", "testing"):
        own = (seed, "C3.2", number, name)
        goals = stream(*own).permutation(world.n_states)[: settings[f"{name}_tasks"]]
        tasks.append([grid_tasks.problem_of(world, int(goal), (*own, i)) for i, goal in enumerate(goals)])
    return Tasks(world, *tasks)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: both learners by choice, and the first ten returns with the prior made task by task."""
    run, default = run_of(settings, seed, cell["run"]), grid_tasks.choices_of(settings)[0]
    schedule = schedule_of(settings, default["schedule"])
    prior = online_prior(run, default, schedule)
    online = grid_tasks.returns_of(
        run.testing, lambda p: grid_tasks.rows_of(p, prior, default["form"], default["ties"]), schedule
    )
    found = grid_tasks.learnt_by_choice(settings, run.testing, {PRIOR: Trained(STATE, run.training)}, cell["run"])
    return {**cell, **found, "online": float(online[:, :10].mean())}


def online_prior(run: Tasks, choice: Mapping, schedule: Schedule) -> ActionPrior:
    """The prior after all training tasks, each learnt with the prior so far, each policy the learner's own.

    A learnt policy is known in states where some action has been found to lead to the goal (Q > 0).
    """
    prior = ActionPrior(4, choice["alpha0"])
    for problem in run.training:
        rows = grid_tasks.rows_of(problem, prior, choice["form"], choice["ties"])
        q = learnt(problem.tables, problem.stream, rows, schedule)[1].q
        prior.update(np.arange(len(q)), learnt_best_actions(q))
    return prior


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Both learners' numbers at the default, and how far the online prior is behind."""
    online, exact, plain = (
        np.array(values)
        for values in (
            [result["online"] for result in results],
            *([r["choices"][0][name]["first_ten"] for r in results] for name in (PRIOR, PLAIN)),
        )
    )
    optimal = np.array([result["optimal"] for result in results])
    return {
        "to_80_eps_qsap": grid_tasks.at_default(results, "to_80", PRIOR),
        "to_80_q_learning": grid_tasks.at_default(results, "to_80", PLAIN),
        "optimal_return": mean_estimate(optimal),
        "online_minus_exact": ratio_estimate(online - exact, optimal - plain),
    }


def _numbers(results: Sequence[Mapping], place: int) -> dict[str, Estimate]:
    firsts = [r["choices"][place][PRIOR]["first"] for r in results if place < len(r["choices"])]
    return {"first": mean_estimate(firsts), **grid_tasks.compared(results, place, PRIOR, PLAIN)}


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The comparison by schedule, ties, form and α⁰."""
    for place, choice in enumerate(grid_tasks.choices_of(settings)):
        yield choice, _numbers(results, place)


METHODS = {"q_learning": ("Q-learning", "q-learning"), "eps_qsap": ("ε-QSAP", "eps-QSAP")}
draw = partial(draw_return_curves, methods=METHODS)
"""Figure of claim C3.2: the thesis's Figure 3.3, returns of ε-QSAP and Q-learning on the lattice."""
