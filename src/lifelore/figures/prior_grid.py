"""Figure of claim C3.2: learning curves under each schedule of ε, and the grid of choices left open."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.learning_curve import draw_curve, draw_episode_bars, draw_optimal
from lifelore.figures.style import GREY, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_NAMES = {None: "q-learning", "uniform": "eps-QSAP", "prior": "eps-QSAP, ties by prior"}
_LABELS = {None: "Q-learning", "uniform": "ε-QSAP, ties uniform", "prior": "ε-QSAP, ties by prior"}


def draw_prior_grid(result: Mapping) -> "Figure":
    """The figure from the result of C3.2."""
    schedules = result["settings"]["schedules"]
    with house_style():
        figure = new_figure(10.4, 8.2)
        upper, lower = figure.subfigures(2, 1, squeeze=False, height_ratios=[1.0, 0.92], hspace=0.02)[:, 0]
        panels = upper.subplots(2, len(schedules), squeeze=False, height_ratios=[1, 0.26], sharey="row")
        for column, schedule in zip(panels.T, schedules, strict=True):
            _draw_schedule(column, result, schedule)
        panels[0, 0].set_ylabel("return of an episode")
        upper.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside upper left", ncols=4)
        _draw_grids(lower.subplots(1, 2, sharey=True), result)
        runs = result["settings"]["runs"]
        lower.supxlabel(
            f"Shaded and thin lines: 95 % interval over {runs} runs. Bold: the interval excludes 0, or 1. Framed: "
            "the default. Bars and ratios: runs that never arrive count as the cap.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _draw_schedule(panels: Sequence["Axes"], result: Mapping, schedule: Sequence[float]) -> None:
    """Curves above, episodes to 80 % of optimal below."""
    above, below = panels
    edges = next(row["curve_edges"] for row in result["rows"] if "curve_edges" in row)
    middle = np.sqrt((np.array(edges[:-1]) + 1) * np.array(edges[1:]))
    curves = [row for row in result["rows"] if "curve_of" in row and row["schedule"] == schedule]
    for row in curves:
        ties = row["curve_of"]["ties"]
        draw_curve(above, middle, row["mean"], (row["low"], row["high"]), _NAMES[ties], _LABELS[ties])
    draw_optimal(above, result["measured"]["optimal_return"]["value"])
    above.axhline(0, color=GREY, linewidth=0.6, zorder=0)
    above.set(xscale="log", xlabel="episode")
    above.xaxis.set_major_formatter("{x:g}")
    above.set_title(schedule_in_words(schedule))
    cells = [_cell(result, schedule, row["curve_of"]) for row in curves]
    names = [_NAMES[cell["ties"]] for cell in cells]
    numbers = [cell["to_80"] for cell in cells]
    cap = result["settings"]["episodes"]
    draw_episode_bars(below, names, [n["value"] for n in numbers], [n["ci95"] for n in numbers], cap)
    below.set(xlim=(0, 1.12 * cap), xlabel="episodes to 80 % of optimal")


def schedule_in_words(schedule: Sequence[float]) -> str:
    """A schedule of ε as people read it."""
    first, decay, floor = schedule
    return f"ε = {first:g}" if decay == 1 else f"ε = {first:g}, × {decay:g} an episode to {floor:g}"


def schedule_in_brief(schedule: Sequence[float]) -> str:
    """The first ε of a schedule and its factor, as a row or column of a table names it."""
    first, decay, _ = schedule
    return f"ε {first:g}" if decay == 1 else f"ε {first:g} × {decay:g}"


def _cell(result: Mapping, schedule: Sequence[float], how: Mapping) -> Mapping:
    keys = ("ties", "alpha0", "form")
    return next(
        row
        for row in result["rows"]
        if "to_80" in row and row["schedule"] == schedule and all(row[k] == how[k] for k in keys)
    )


def _draw_grids(panels: Sequence["Axes"], result: Mapping) -> None:
    settings, default = result["settings"], result["settings"]["default"]
    cells = [row for row in result["rows"] if row.get("form") and "to_80" in row]
    hows = list(dict.fromkeys((cell["form"], cell["alpha0"]) for cell in cells))
    columns = [(schedule, ties) for schedule in settings["schedules"] for ties in settings["ties"]]
    table = [[_cell(result, s, {"ties": t, "alpha0": a, "form": f}) for s, t in columns] for f, a in hows]
    heads = [f"{_brief(schedule)}\nties {ties}" for schedule, ties in columns]
    sides = [form if alpha0 is None else f"{form}, α⁰ {alpha0:g}" for form, alpha0 in hows]
    framed = (
        hows.index((default["form"], default["alpha0"])),
        columns.index((default["schedule"], default["ties"])),
    )
    first = {"neutral": 0.0, "spread": 40.0, "good": "high", "words": _signed}
    ratio = {"neutral": 1.0, "spread": 4.0, "ratio": True, "good": "low", "words": "{:.2f}".format}
    for axes, key, look in ((panels[0], "first", first), (panels[1], "to_80_ratio", ratio)):
        numbers = [[cell[key] for cell in row] for row in table]
        values = [[n["value"] for n in row] for row in numbers]
        certain = [[_excludes(n["ci95"], look["neutral"]) for n in row] for row in numbers]
        draw_heat_grid(axes, values, certain, sides, heads, outlined=framed, **look)
    panels[0].set_title("Return of the first episode")
    panels[1].set_title("Episodes to 80 % of optimal, as a ratio to Q-learning")


def _signed(value: float) -> str:
    return f"{value:+.1f}".replace("-", "−")


def _brief(schedule: Sequence[float]) -> str:
    first, decay, _ = schedule
    return f"ε {first:g}" if decay == 1 else f"ε {first:g} × {decay:g}"


def _excludes(interval: Sequence[float] | None, neutral: float) -> bool:
    return bool(interval) and not interval[0] <= neutral <= interval[1]
