"""Figure of claim C3.17: advice in 100 steps by κ, the ceiling of κ, and how advice falls as Q-learning learns."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures import style
from lifelore.figures.curves import draw_curves
from lifelore.figures.style import Axes, Figure, house_style, new_figure, two_rows
from reproduction.chapter3.advice.figures import (
    AGENT_COLOURS,
    AGENTS,
    EXPERTS_IN_WORDS,
    EXPLORERS,
    draw_maze_grid,
)
from reproduction.chapter3.advice.mazes import grid_of
from reproduction.engine.results_table import ResultsTable

FIXED = (*EXPLORERS, "optimal")
EXPERT_COLOURS = {
    "walks": style.BLUE,
    "few walks": style.ORANGE,
    "trips": style.GREEN,
    "policies": style.VERMILION,
}


@house_style()
def draw(result: Mapping) -> Figure:
    """Advice by κ, heeded and not; the ceiling; Q-learning; and the grid at one κ."""
    settings = result["settings"]
    default, keys = settings["default"], ("loops", "experts", "heeds", "agent")
    table = ResultsTable((row for row in result["rows"] if "mean" in row), keys)
    figure = new_figure(10.4, 8.6)
    upper, lower = two_rows(figure, (1.5, 1))
    panels = upper.subplots(2, 2)
    for axes, heeds in zip(panels[0], (True, False), strict=True):
        _draw_amounts(axes, settings, table.select(**{**default, "heeds": heeds}))
        axes.set_title("Agents who follow advice" if heeds else "Agents who are only watched")
    panels[0, 0].set_ylabel("advised steps in 100")
    upper.legend(*panels[0, 1].get_legend_handles_labels(), loc="outside upper left", ncols=5)
    _draw_ceiling(panels[1, 0], result)
    _draw_learning(panels[1, 1], settings, table.select(**default))
    _draw_grid(lower.subplots(), result, table)
    lower.supxlabel(
        f"Bars: one standard deviation over {settings['mazes']} mazes of {settings['tasks']} walks of at most "
        f"{settings['max_steps']:,} steps. Curves: loops {default['loops']:g}, experts "
        f"{default['experts']}. Framed: the default.\n{EXPERTS_IN_WORDS}",
        fontsize=8, color=style.GREY,
    )  # fmt: skip
    return figure


def _draw_amounts(axes: Axes, settings: Mapping, table: ResultsTable) -> None:
    kappas = np.array(settings["kappas"])
    for place, agent in enumerate(FIXED):
        row = table.record(agent=agent)
        axes.errorbar(
            kappas + 0.004 * kappas[-1] * (place - 2), row["mean"], row["deviation"], color=AGENT_COLOURS[agent],
            label=AGENTS[agent], lw=1.6, elinewidth=0.8, marker="o", ms=3,
        )  # fmt: skip
    axes.axvline(settings["kappa"], color=style.GREY, lw=0.9, ls=(0, (4, 3)))
    axes.set(xlabel="κ (nats)", ylim=(0, 104))
    axes.grid(axis="y", color=style.LIGHT)


def _draw_ceiling(axes: Axes, result: Mapping) -> None:
    settings = result["settings"]
    rows = [r for r in result["rows"] if "ceiling" in r and r["loops"] == settings["default"]["loops"]]
    series = {row["experts"]: {"mean": 100 * np.array(row["ceiling"])} for row in rows}
    looks = {kind: {"color": colour, "marker": "o", "ms": 3, "lw": 1.6} for kind, colour in EXPERT_COLOURS.items()}
    draw_curves(
        axes, settings["kappas"], series, looks=looks, xlabel="κ (nats)", ylabel="states (%)", legend=False
    )
    axes.axvline(settings["kappa"], color=style.GREY, lw=0.9, ls=(0, (4, 3)))
    for ways in (1, 2, 3):
        axes.axvline(np.log(4 / ways), color=style.INK, lw=0.8, ls=(0, (1, 2)))
        axes.annotate(
            f"log 4/{ways}", (np.log(4 / ways), 0), (3, 4), xycoords=("data", "axes fraction"),
            textcoords="offset points", rotation=90, ha="left", va="bottom", fontsize=7, color=style.GREY,
        )  # fmt: skip
    axes.set(title="Ceiling: states where advice is possible at all", ylim=(0, 104))
    axes.grid(axis="y", color=style.LIGHT)
    axes.legend(loc="lower left", bbox_to_anchor=(0, 0.1), title="experts", title_fontsize=8)


def _draw_learning(axes: Axes, settings: Mapping, table: ResultsTable) -> None:
    k = settings["kappas"].index(settings["kappa"])
    rows = [table.record(agent=f"q {episodes}") for episodes in settings["snapshots"]]
    mean, deviation = ([row[key][k] for row in rows] for key in ("mean", "deviation"))
    axes.errorbar(
        settings["snapshots"], mean, deviation, color=AGENT_COLOURS["q-learning"], marker="o", ms=3.5,
        elinewidth=0.8, label="Q-learning so far",
    )  # fmt: skip
    for agent in ("random", "optimal"):
        level = table.record(agent=agent)["mean"][k]
        axes.axhline(level, color=AGENT_COLOURS[agent], lw=1.2, ls=(0, (4, 2)), label=AGENTS[agent])
    axes.set(xscale="log", xlabel="episodes learnt", ylabel="advised steps in 100")
    axes.set(title=f"Q-learning at κ = {settings['kappa']:g}", ylim=(0, None))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.grid(axis="y", color=style.LIGHT)
    axes.legend(loc="lower left", frameon=True, framealpha=1, edgecolor="none")


def _draw_grid(axes: Axes, result: Mapping, table: ResultsTable) -> None:
    settings, heeds = result["settings"], result["settings"]["default"]["heeds"]
    k = settings["kappas"].index(settings["kappa"])
    learners = {f"q {n}": f"Q-learning, {n} ep." for n in (settings["snapshots"][i] for i in (0, -1))}
    sides = {agent: AGENTS[agent] for agent in FIXED} | learners
    values = [
        [table.record(loops=n, experts=e, heeds=heeds, agent=agent)["mean"][k] for n, e in grid_of(settings)]
        for agent in sides
    ]
    title = f"Advised steps in 100 at κ = {settings['kappa']:g}"
    look = {"neutral": 0.0, "spread": 100.0, "words": "{:.0f}".format}
    draw_maze_grid(axes, result, values, np.zeros(np.shape(values)), list(sides.values()), title=title, **look)
