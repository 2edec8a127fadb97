"""Figure of claim C3.3: learning curves in noise mazes under each schedule of ε, and the grid of open choices."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.learning_curve import draw_curve, draw_episode_bars, draw_optimal
from lifelore.figures.prior_grid import schedule_in_words
from lifelore.figures.style import GREY, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_noise_grid(result)


_NAMES = {
    "q_learning": "q-learning",
    "qsap": "eps-QSAP",
    "qpap": "eps-QPAP",
    "qsap_noise": "eps-QSAP",
    "qpap_lattice": "eps-QPAP",
}
_LABELS = {
    "q_learning": "Q-learning",
    "qsap": "ε-QSAP, lattice",
    "qpap": "ε-QPAP, noise mazes",
    "qsap_noise": "ε-QSAP, noise mazes",
    "qpap_lattice": "ε-QPAP, lattice",
}
_DASHED = ("qsap_noise", "qpap_lattice")
_PAIRS = (
    ("qpap", "q_learning", "ε-QPAP against Q-learning"),
    ("qpap", "qsap", "ε-QPAP against ε-QSAP"),
    ("qsap", "q_learning", "ε-QSAP against Q-learning"),
)


def draw_noise_grid(result: Mapping) -> "Figure":
    """The figure from the result of C3.3."""
    schedules = result["settings"]["schedules"]
    with house_style():
        figure = new_figure(12.4, 10.2)
        upper, lower = figure.subfigures(2, 1, squeeze=False, height_ratios=[0.95, 1.1], hspace=0.02)[:, 0]
        panels = upper.subplots(2, len(schedules), squeeze=False, height_ratios=[1, 0.34], sharey="row")
        for column, schedule in zip(panels.T, schedules, strict=True):
            _draw_schedule(column, result, schedule)
        panels[0, 0].set_ylabel("return of an episode")
        upper.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside upper left", ncols=6)
        _draw_grids(lower.subplots(2, len(_PAIRS), sharex=True, sharey=True), result)
        runs = result["settings"]["runs"]
        lower.supxlabel(
            f"Shaded and thin lines: 95 % interval over {runs} runs. Dashed, pale: trained where the other prior "
            "was. Bold: the interval excludes 0, or 1. Framed: the default.\nBars and ratios: runs that never "
            "arrive count as the cap.",
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
        method, dashed = row["curve_of"], row["curve_of"] in _DASHED
        interval = None if dashed else (row["low"], row["high"])
        draw_curve(above, middle, row["mean"], interval, _NAMES[method], _LABELS[method])
        if dashed:
            above.lines[-1].set(linestyle=(0, (3, 1.5)), linewidth=1.0)
    draw_optimal(above, result["measured"]["optimal_return"]["value"])
    above.axhline(0, color=GREY, linewidth=0.6, zorder=0)
    above.set(xscale="log", xlabel="episode")
    above.xaxis.set_major_formatter("{x:g}")
    above.set_title(schedule_in_words(schedule))
    numbers, cap = [row["to_80"] for row in curves], result["settings"]["episodes"]
    names = [_NAMES[row["curve_of"]] for row in curves]
    draw_episode_bars(below, names, [n["value"] for n in numbers], [n["ci95"] for n in numbers], cap)
    for bar, row in zip(below.patches, curves, strict=True):
        bar.set_alpha(0.35 if row["curve_of"] in _DASHED else 0.9)
    below.set(xlim=(0, 1.12 * cap), xlabel="episodes to 80 % of optimal")


def _draw_grids(panels, result: Mapping) -> None:
    settings = result["settings"]
    cells = {_key(row): row for row in result["rows"] if "form" in row}
    columns = [(schedule, ties) for schedule in settings["schedules"] for ties in settings["ties"]]
    sides = list(dict.fromkeys(_side(row) for row in cells.values()))
    table = [[cells.get((side, tuple(s), ties)) for s, ties in columns] for side in sides]
    heads = [f"ε {s[0]:g}" + ("" if s[1] == 1 else f"\n× {s[1]:g}") + f"\n{ties}" for s, ties in columns]
    default = settings["default"]
    framed = (sides.index(_side(default)), columns.index((default["schedule"], default["ties"])))
    words = [_in_words(side, default) for side in sides]
    first = {"neutral": 0.0, "spread": 60.0, "good": "high", "words": _signed}
    ratio = {"neutral": 1.0, "spread": 4.0, "ratio": True, "good": "low", "words": "{:.2f}".format}
    for column, (one, other, title) in enumerate(_PAIRS):
        for axes, key, look in (
            (panels[0, column], f"first_{one}_minus_{other}", first),
            (panels[1, column], f"to_80_ratio_{one}_to_{other}", ratio),
        ):
            numbers = [[cell and cell[key] for cell in row] for row in table]
            values = [[n["value"] if n else np.nan for n in row] for row in numbers]
            certain = [[_excludes(n, look["neutral"]) for n in row] for row in numbers]
            draw_heat_grid(axes, values, certain, words, heads, outlined=framed, **look)
        panels[0, column].set_title(f"{title}:\nfirst return, difference")
        panels[1, column].set_title("episodes to 80 % of optimal, ratio")


def _side(how: Mapping) -> tuple:
    return (how["form"], how["alpha0"], how["max_steps"], how["training_tasks"])


def _key(row: Mapping) -> tuple:
    return (_side(row), tuple(row["schedule"]), row["ties"])


def _in_words(side: tuple, default: Mapping) -> str:
    """What a row of the grid is: its form, or what in it differs from the default."""
    form, alpha0, max_steps, training_tasks = side
    if max_steps != default["max_steps"]:
        return f"cap of {max_steps} steps"
    if training_tasks != default["training_tasks"]:
        return f"{training_tasks} training tasks"
    return form if alpha0 is None else f"{form}, α⁰ {alpha0:g}"


def _signed(value: float) -> str:
    return f"{value:+.1f}".replace("-", "−")


def _excludes(number: Mapping | None, neutral: float) -> bool:
    interval = number and number["ci95"]
    return bool(interval) and not interval[0] <= neutral <= interval[1]
