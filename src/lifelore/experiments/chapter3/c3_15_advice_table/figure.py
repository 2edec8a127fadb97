"""Figure of claim C3.15: rewards with and without advice, those printed, and the grid of choices left open."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter3.explorer_palette import ADVISOR_NAMES, ADVISORS, EXPERT_NAMES, NAMES
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import GREY, INK, LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PRINTED = {
    "random": (50, 900),
    "avoid": (50, 750),
    "left": (150, 750),
    "bug": (100, 800),
    "q-learning": (150, 1000),
    "optimal": (1000, 1000),
}
"""Table 3.1: without and with advice."""


def draw(result: Mapping):
    return draw_advice_bars(result, PRINTED)


_WIDTH = 0.2


def draw_advice_bars(result: Mapping, printed: Mapping[str, tuple[float, float]]) -> "Figure":
    """The figure from the result of C3.15; `printed`: rewards without and with advice, by agent."""
    with house_style():
        figure = new_figure(10.4, 8.4)
        upper, lower = figure.subfigures(2, 1, squeeze=False, height_ratios=[1, 1.05], hspace=0.02)[:, 0]
        axes = upper.subplots()
        _draw_bars(axes, result, printed)
        upper.legend(*axes.get_legend_handles_labels(), loc="outside upper left", ncols=5)
        _draw_grids(lower.subplots(2, 1, sharex=True), result)
        settings = result["settings"]
        lower.supxlabel(
            f"{settings['mazes']} mazes × {settings['tasks']} tasks a cell. Thin lines: 95 % interval over mazes; "
            "brackets: advised steps in 100. Bold: the gain's interval excludes 0 (above), at least 700 (below).",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _at_default(result: Mapping, agent: str, way: str) -> Mapping | None:
    default = result["settings"]["default"]
    wanted = {"loops": default["loops"], "experts": default["experts"], "agent": agent, "way": way}
    return _row(result, wanted)


def _row(result: Mapping, wanted: Mapping) -> Mapping | None:
    rows = (row for row in result["rows"] if all(row[key] == value for key, value in wanted.items()))
    return next(rows, None)


def _draw_bars(axes: "Axes", result: Mapping, printed: Mapping) -> None:
    for place, agent in enumerate(NAMES):
        for shift, way in enumerate(ADVISORS):
            row = _at_default(result, agent, way)
            if row:
                _draw_bar(axes, place + (shift - 1.5) * _WIDTH, row, way, label=place == 0)
        for shift, value in enumerate(printed[agent]):
            x = place + (shift - 1.5) * _WIDTH
            axes.plot([x - 0.09, x + 0.09], [value, value], color=INK, lw=2, zorder=6, solid_capstyle="butt")
            axes.plot([x], [value], marker="D", ms=4, color=INK, zorder=6, ls="")
    axes.plot([], [], marker="D", ms=4, color=INK, lw=2, label="printed in Table 3.1")
    axes.set_xticks(range(len(NAMES)), list(NAMES.values()))
    axes.set(ylim=(0, 1120), ylabel="reward, of 1000", yticks=range(0, 1001, 250))
    axes.grid(axis="y", color=LIGHT)
    axes.tick_params(axis="x", length=0)


def _draw_bar(axes: "Axes", x: float, row: Mapping, way: str, label: bool) -> None:
    name = ADVISOR_NAMES[way] if label else None
    axes.bar([x], [row["reward"]], width=0.92 * _WIDTH, color=ADVISORS[way], alpha=0.9, label=name, zorder=2)
    top = row["reward"]
    if row["ci95"]:
        axes.plot([x, x], row["ci95"], color=INK, lw=1.1, zorder=4)
        top = max(top, row["ci95"][1])
    text = f"{row['reward']:.0f}"
    if row.get("advised") and way != "none":
        text += f"\n({row['advised']:.0f})"
    axes.annotate(
        text, (x, top), (0, 3), textcoords="offset points", ha="center", va="bottom", fontsize=7, zorder=7,
        linespacing=0.95, bbox={"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 0.4},
    )  # fmt: skip


def _draw_grids(panels: Sequence["Axes"], result: Mapping) -> None:
    settings, default = result["settings"], result["settings"]["default"]
    columns = [(loops, experts) for loops in settings["loops"] for experts in settings["experts"]]
    heads = [f"{EXPERT_NAMES[experts]}\n{loops:g}" for loops, experts in columns]
    framed = columns.index((default["loops"], default["experts"]))
    table = {
        "thesis": ("gain", ("random", "avoid", "left", "bug", "q-learning", "optimal")),
        "better": ("reward", ("random", "avoid", "left", "bug", "optimal")),
        "uniform only": ("reward", ("random", "avoid", "left", "bug")),
    }
    _draw_grid(panels[0], result, columns, heads, {"thesis": table.pop("thesis")}, 0.0, 500.0)
    _draw_grid(panels[1], result, columns, heads, table, 700.0, 450.0)
    panels[0].set_title("Gain by the thesis's advisor")
    panels[1].set_title(
        "Reward with the better advisor (goal: 700), and where Uniform is its only other model (*)"
    )
    panels[1].set_xlabel("experts, and share of walls opened into loops")
    for axes in panels:
        axes.axvspan(framed - 0.5, framed + 0.5, fill=False, ec=INK, lw=1.6, zorder=3)


def _draw_grid(
    axes: "Axes", result: Mapping, columns, heads, table: Mapping, neutral: float, spread: float
) -> None:
    sides, values, certain = [], [], []
    for way, (key, agents) in table.items():
        for agent in agents:
            found = [
                _row(result, {"loops": loops, "experts": e, "way": way, "agent": agent}) for loops, e in columns
            ]
            values.append([row[key] if row else np.nan for row in found])
            certain.append([bool(row and _stands_out(row, key, neutral)) for row in found])
            sides.append(NAMES[agent] + (" *" if way == "uniform only" else ""))
    words = _signed if neutral == 0 else "{:.0f}".format
    draw_heat_grid(axes, values, certain, sides, heads, neutral=neutral, spread=spread, words=words)


def _stands_out(row: Mapping, key: str, neutral: float) -> bool:
    return row["gain_is_certain"] if key == "gain" else row["reward"] >= neutral


def _signed(value: float) -> str:
    return f"{value:+.0f}".replace("-", "−") if abs(value) >= 0.5 else "0"
