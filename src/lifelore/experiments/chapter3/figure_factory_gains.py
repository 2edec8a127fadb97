"""Figure of claims C3.5 and C3.6: reward against the number of prior tasks, and what is gained over the grid."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter3.figure_factory_priors import ENCODINGS
from lifelore.experiments.chapter3.reward_curves import schedule_in_words
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.learning_curve import draw_curve
from lifelore.figures.style import GREY, INK, colour_of, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw_factory_gains(result: Mapping) -> "Figure":
    """The figure from the result of C3.5 or C3.6: a panel for each number of components, and the grid."""
    settings = result["settings"]
    numbers = settings["components"]
    with house_style():
        figure = new_figure(4.8 + 3.6 * len(numbers), 5.4)
        widths = [*([1.0] * len(numbers)), 1.15]
        *panels, grid = figure.subplots(1, len(numbers) + 1, width_ratios=widths)
        for axes, k in zip(panels, numbers, strict=True):
            _draw_series(axes, result, k)
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=4)
        _draw_grid(grid, result)
        figure.supxlabel(_caption(settings), fontsize=8, color=GREY)
    return figure


def _caption(settings: Mapping) -> str:
    default = settings["default"]
    return (
        "Each task is learnt with the prior of all before it, and from scratch. Exact: their optimal policies "
        "count; own: those the learner ended with.\n"
        f"{settings['episodes']} episodes of {settings['max_steps']} steps at most; default: "
        f"{schedule_in_words(default['schedule'])}; ties {default['ties']}; α⁰ {default['alpha0']:g}; "
        f"configurations by the {ENCODINGS[default['encoding']]}.\n"
        f"Shaded: 95 % interval over {settings['runs']} runs. The table: the last task with the prior of "
        f"{settings['grid_tasks'][-1]}; bold: the interval excludes 0."
    )


def _draw_series(axes: "Axes", result: Mapping, k: int) -> None:
    bands = {row["series"]: row for row in result["rows"] if row.get("components") == k and "series" in row}
    settings = result["settings"]
    x = np.arange(settings["prior_tasks"] + 1)

    def draw(series: str, name: str, label: str) -> None:
        draw_curve(axes, x, bands[series]["mean"], (bands[series]["low"], bands[series]["high"]), name, label)

    draw("uniform", "q-learning", "from scratch (Q-learning)")
    for encoding in settings["encodings"]:
        draw(f"exact {encoding}", encoding, f"exact, {ENCODINGS[encoding]}")
    own = settings["default"]["encoding"]
    words = f"own, {ENCODINGS[own]}"
    axes.plot(
        x, bands[f"own {own}"]["mean"], color=colour_of(own), linestyle=(0, (3, 2)), linewidth=1.3, label=words
    )
    axes.plot(x, bands["optimal"]["mean"], color=INK, linestyle=(0, (1, 2)), linewidth=1.2, label="optimal")
    axes.set(xlabel="tasks behind the prior", ylabel="reward of an episode")
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}".replace("-", "−"))
    # Intervals of few runs reach far above what can be earned.
    axes.set_ylim(top=max(bands["optimal"]["mean"]) - 0.06 * min(bands["uniform"]["mean"]))
    axes.set_title(f"{k} component{'s' if k > 1 else ''}")


def _draw_grid(axes: "Axes", result: Mapping) -> None:
    """Share of what could be gained after few and after all prior tasks."""
    settings, default = result["settings"], result["settings"]["default"]
    cells = {_key(row): row for row in result["rows"] if "growth" in row}
    sides = [(encoding, alpha0) for encoding in settings["encodings"] for alpha0 in settings["alpha0"]]
    columns = [(schedule, ties) for schedule in settings["schedules"] for ties in settings["ties"]]
    rows = [[cells[(*side, ties, tuple(schedule))] for schedule, ties in columns] for side in sides]
    draw_heat_grid(
        axes,
        [[100 * row["many"]["value"] for row in line] for line in rows],
        [[_excludes_zero(row["many"]["ci95"]) for row in line] for line in rows],
        [f"{encoding}, α⁰ {alpha0:g}" for encoding, alpha0 in sides],
        [f"{_brief(schedule)}\nties {ties}" for schedule, ties in columns],
        neutral=0.0, spread=100.0, words=lambda value: f"{value:.0f}".replace("-", "−"),
        outlined=(
            sides.index((default["encoding"], default["alpha0"])),
            columns.index((default["schedule"], default["ties"])),
        ),
    )  # fmt: skip
    axes.tick_params(axis="x", labelsize=6.5)
    axes.set_title("Gained of what could be (%)")


def _key(row: Mapping) -> tuple:
    return (row["encoding"], row["alpha0"], row["ties"], tuple(row["schedule"]))


def _brief(schedule: Sequence[float]) -> str:
    first, decay, _ = schedule
    return f"ε {first:g}" if decay == 1 else f"ε {first:g}\n× {decay:g}"


def _excludes_zero(interval: Sequence[float] | None) -> bool:
    return bool(interval) and not interval[0] <= 0 <= interval[1]
