"""C3.5, and C3.6: a sequence of factory tasks, each learnt with the prior of all before it.

There are only nine tasks of one component, so that at the end all have been met. The thesis does not say whose
policies count: exact optimal ones, or those that the learner ends with. Thesis: §3.4.3, Figures 3.8 and 3.9.
"""

from collections.abc import Iterator, Mapping, Sequence
from math import comb
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.figures.style import BLUE, GREY, INK, Axes
from reproduction.chapter3.factory import comparison, learning
from reproduction.chapter3.factory.comparison import UNIFORM, is_default
from reproduction.chapter3.factory.learning import LEARNT, problem_of, tasks_of, tried_actions, with_pseudo_count
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.grid import Cell, Grid
from reproduction.engine.learning_run import learnt
from reproduction.engine.records import curve_of, having, nested, values_of
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

SOURCES = ("exact", "learnt")
N_COMPONENTS = 9
shared = (
    "discount", "prior_tasks", "episodes", "learning_rate", "late", "encoding", "schedule", "max_steps", "ties",
    "alpha0", "source",
)  # fmt: skip


def grid_of(settings: Mapping) -> Grid:
    """The grid: codes of states × schedules, every other choice alone."""
    return comparison.grid_of(settings, ("encoding", "schedule"), ("max_steps", "ties", "alpha0", "source"))


def cells(settings: Mapping) -> list[dict]:
    """A sequence for each run and number of components."""
    return [{"components": k, "run": run} for k in settings["components"] for run in range(settings["runs"])]


def windows(settings: Mapping) -> tuple[range, range]:
    """The first tasks with a prior, and the last ones: at most ``late`` each."""
    n = settings["prior_tasks"] + 1
    length = min(settings["late"], n - 1)
    return range(1, 1 + length), range(n - length, n)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Mean reward of an episode in each task, by method and choices; task n has n tasks before it.

    At the default every task is learnt, elsewhere those of the `windows`; the others are None.
    """
    k, run, grid = cell["components"], cell["run"], grid_of(settings)
    tasks = tasks_of(settings, seed, k, run, settings["prior_tasks"] + 1)
    asked = {n for window in windows(settings) for n in window}
    found = [{"method": m, **how, "rewards": []} for m in (UNIFORM, LEARNT) for how in grid.cells_of(m)]
    priors = {
        (source, code): ActionPrior(learning.N_ACTIONS, 1.0) for source in SOURCES for code in settings["encoding"]
    }
    optimal = []
    for n, components in enumerate(tasks):
        problem = problem_of(settings, components, (seed, "factory", k, run, n))
        optimal.append(problem.optimal)
        own = None
        for record in found:
            if not (n in asked or is_default(grid, record, but=["source"])):
                record["rewards"].append(None)
                continue
            rows = None
            if record["method"] == LEARNT:
                prior = with_pseudo_count(priors[record["source"], record["encoding"]], record["alpha0"])
                rows = learning.rows_of(problem, record["encoding"], prior.probs, record["ties"])
            schedule = schedule_of({**settings, "max_steps": record["max_steps"]}, record["schedule"])
            curve, learner = learnt(problem.tables, problem.stream, rows, schedule)
            record["rewards"].append(float(curve.rewards.mean()))
            if record["source"] == "learnt":
                own = tried_actions(learner, problem.task.completed)
        for (source, encoding), prior in priors.items():
            best = problem.best if source == "exact" else own
            if best is not None:
                prior.update(learning.contexts_of(problem, encoding), best)
    seen = [components in tasks[:n] for n, components in enumerate(tasks)]
    return {**cell, "found": found, "optimal": optimal, "seen": seen, "met": len(set(tasks[:-1]))}


class Sequences(NamedTuple):
    """The sequences of one number of components in one cell of the grid, arrays (n_runs, n_tasks)."""

    gain: NDArray[np.float64]
    """Reward of an episode beyond that from scratch."""
    distance: NDArray[np.float64]
    """From scratch to the optimum."""

    @classmethod
    def of(cls, results: Sequence[Mapping], grid: Grid, cell: Mapping) -> "Sequences":
        """The sequences of `results`, all of the same number of components."""
        found = nested(results, "found")
        learnt, uniform = (values_of(found, "rewards", **grid.where(m, cell)) for m in (LEARNT, UNIFORM))
        return cls(learnt - uniform, np.array([result["optimal"] for result in results]) - uniform)

    def share(self, tasks: Sequence[int]) -> NDArray[np.float64]:
        """The gain in some tasks as a share of the distance there, (n_runs,)."""
        tasks = list(tasks)
        return self.gain[:, tasks].sum(axis=1) / self.distance[:, tasks].sum(axis=1)

    def numbers(self, settings: Mapping, seen: NDArray[np.bool_]) -> dict[str, Estimate]:
        """Shares of the distance: the late gain, the late gain less the first, and the late gain in new tasks."""
        first, late = map(list, windows(settings))
        gain, room = self.gain[:, late].mean(axis=1), self.distance[:, late].mean(axis=1)
        found = {
            "gain_late": ratio_estimate(gain, room),
            "growth": ratio_estimate(gain - self.gain[:, first].mean(axis=1), room),
        }
        late_of_runs = zip(self.gain[:, late], self.distance[:, late], ~seen[:, late], strict=True)
        new = [(g[unseen].mean(), d[unseen].mean()) for g, d, unseen in late_of_runs if unseen.any()]
        return {**found, "gain_new": ratio_estimate(*zip(*new, strict=True))} if new else found


def seen_of(results: Sequence[Mapping]) -> NDArray[np.bool_]:
    """Whether each task was met before, (n_runs, n_tasks)."""
    return np.array([result["seen"] for result in results])


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """How many tasks were met."""
    k = settings["components"][0]
    own = having(results, components=k)
    return {
        "late_tasks_seen": mean_estimate(seen_of(own)[:, list(windows(settings)[1])].mean(axis=1)),
        "share_of_tasks_met": mean_estimate([result["met"] / comb(N_COMPONENTS, k) for result in own]),
    }


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[Cell, dict[str, Estimate]]]:
    """The gains in every cell of the grid."""
    own, grid = having(results, components=settings["components"][0]), grid_of(settings)
    for cell in grid.cells:
        yield cell, Sequences.of(own, grid, cell).numbers(settings, seen_of(own))


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean reward and its standard deviation by number of prior tasks."""
    own, grid = having(results, components=settings["components"][0]), grid_of(settings)
    found = {
        method: values_of(nested(own, "found"), "rewards", **grid.where(method, grid.default))
        for method in (UNIFORM, LEARNT)
    }
    found["optimal"] = np.array([result["optimal"] for result in own])
    return [{"curve_of": name, **curve_of(values)} for name, values in found.items()]


LOOKS = {
    "learnt": ("accumulated prior", {"color": BLUE}),
    "uniform": ("from scratch", {"color": GREY}),
    "optimal": ("optimal", {"color": INK, "linestyle": (0, (1, 2))}),
}


@panels(6.4, 4.2, grid="")
def draw(result: Mapping, axes: Axes) -> None:
    """Figure of C3.5, and of C3.6: reward of an episode against the number of prior tasks.

    The figure from the result of C3.5 or C3.6.
    """
    settings, rows = result["settings"], {row["curve_of"]: row for row in result["rows"]}
    series = {label: rows[name] for name, (label, _) in LOOKS.items()}
    series["optimal"] = {"mean": rows["optimal"]["mean"]}
    draw_curves(
        axes, np.arange(len(rows["optimal"]["mean"])), series, looks=dict(LOOKS.values()),
        xlabel="number of prior tasks", ylabel="average reward of an episode", legend=False,
    )  # fmt: skip
    axes.set_xlim(0, settings["prior_tasks"])
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}".replace("-", "−"))
    axes.legend(loc="center right")
    axes.figure.supxlabel(
        f"{settings['runs']} runs, {settings['episodes']} episodes a task; shaded: one standard deviation.",
        fontsize=8, color=GREY,
    )  # fmt: skip
