"""Figure of C3.5, and of C3.6: reward against the number of prior tasks, and what is gained over the grid."""

from collections.abc import Mapping
from textwrap import fill

import numpy as np

from lifelore.figures.curves import draw_curves
from lifelore.figures.heat_grid import name_groups
from lifelore.figures.style import GREY, INK, Axes, Figure, colour_of, house_style, new_figure, width_of
from reproduction.chapter3.factory.learning import ENCODINGS
from reproduction.chapter3.figures.choice_grid import draw_choice_grid
from reproduction.chapter3.learning.schedules import schedule_in_words


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result of C3.5 or C3.6: a panel for each number of components, and the grid."""
    settings = result["settings"]
    numbers = settings["components"]
    figure = new_figure(5.2 + 3.6 * len(numbers), 5.6)
    *panels, grid = figure.subplots(1, len(numbers) + 1, width_ratios=[*([1.0] * len(numbers)), 1.15])
    for axes, k in zip(panels, numbers, strict=True):
        _draw_series(axes, result, k)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=4)
    draw_choice_grid(
        grid, settings, [row for row in result["rows"] if "growth" in row], "many", ("encoding", "alpha0"),
        lambda _, alpha0: f"α⁰ {alpha0:g}", neutral=0.0, spread=100.0, scale=100.0, words="{:.0f}".format,
    )  # fmt: skip
    n_each = len({row["alpha0"] for row in result["rows"] if "growth" in row})
    name_groups(grid, [(fill(ENCODINGS[encoding], 13), n_each) for encoding in settings["encodings"]], 48)
    grid.set_title("Gained of the possible gain (%)")
    figure.supxlabel(_caption(settings), fontsize=8, color=GREY)
    return figure


def _caption(settings: Mapping) -> str:
    default = settings["default"]
    return (
        "Each task is learnt with the prior of all before it, and from scratch. Exact: their optimal policies "
        "count; own: the policies that the learner ended with.\n"
        f"{settings['episodes']} episodes of {settings['max_steps']} steps at most; default: "
        f"{schedule_in_words(default['schedule'])}; ties {default['ties']}; α⁰ {default['alpha0']:g}; "
        f"configurations by the {ENCODINGS[default['encoding']]}.\n"
        f"Shaded: 95 % interval over {settings['runs']} runs. The table, by ε and ties: the last task with the "
        f"prior of {settings['grid_tasks'][-1]}; bold: the interval excludes 0; framed: the default."
    )


def _draw_series(axes: Axes, result: Mapping, k: int) -> None:
    settings, bands = result["settings"], {}
    for row in result["rows"]:
        if row.get("components") == k and "series" in row:
            bands[row["series"]] = {part: row[part] for part in ("mean", "low", "high")}
    own = settings["default"]["encoding"]
    shown = {"from scratch (Q-learning)": (bands["uniform"], _look("q-learning"))}
    for encoding in settings["encodings"]:
        shown[f"exact, {ENCODINGS[encoding]}"] = (bands[f"exact {encoding}"], _look(encoding))
    dashed = {"color": colour_of(own), "linestyle": (0, (3, 2)), "linewidth": 1.3}
    shown[f"own, {ENCODINGS[own]}"] = ({"mean": bands[f"own {own}"]["mean"]}, dashed)
    dotted = {"color": INK, "linestyle": (0, (1, 2)), "linewidth": 1.2}
    shown["optimal"] = ({"mean": bands["optimal"]["mean"]}, dotted)
    curves, looks = ({label: both[i] for label, both in shown.items()} for i in (0, 1))
    draw_curves(
        axes, np.arange(settings["prior_tasks"] + 1), curves, looks=looks,
        title=f"{k} component{'s' if k > 1 else ''}", xlabel="tasks behind the prior",
        ylabel="reward of an episode", legend=False,
    )  # fmt: skip
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}".replace("-", "−"))
    # Intervals of few runs reach far above what can be earned.
    axes.set_ylim(top=max(bands["optimal"]["mean"]) - 0.06 * min(bands["uniform"]["mean"]))


def _look(name: str) -> dict:
    return {"color": colour_of(name), "linewidth": width_of(name), "zorder": 10 - width_of(name)}
