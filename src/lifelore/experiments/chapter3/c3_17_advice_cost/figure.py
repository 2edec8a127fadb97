"""Figure of claim C3.17: advice per 100 steps by κ, the ceiling of κ, and how it falls as Q-learning learns."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter3.explorer_palette import AGENTS, EXPERT_NAMES, NAMES
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_advice_amount(result)


_FIXED = ("random", "avoid", "left", "bug", "optimal")
_EXPERTS = {"walks": BLUE, "few walks": ORANGE, "trips": GREEN, "policies": VERMILION}


def draw_advice_amount(result: Mapping) -> "Figure":
    """The figure from the result of C3.17."""
    with house_style():
        figure = new_figure(10.4, 8.6)
        upper, lower = figure.subfigures(2, 1, squeeze=False, height_ratios=[1.5, 1], hspace=0.02)[:, 0]
        panels = upper.subplots(2, 2)
        for axes, heeds in zip(panels[0], (True, False), strict=True):
            _draw_amounts(axes, result, heeds)
        panels[0, 0].set_ylabel("advised steps in 100")
        upper.legend(*panels[0, 1].get_legend_handles_labels(), loc="outside upper left", ncols=5)
        _draw_ceiling(panels[1, 0], result)
        _draw_learning(panels[1, 1], result)
        _draw_grid(lower.subplots(), result)
        settings = result["settings"]
        lower.supxlabel(
            f"Bars: one standard deviation over {settings['mazes']} mazes of {settings['tasks']} walks of at most "
            f"{settings['max_steps']:,} steps. Curves: loops {settings['default']['loops']:g}, experts "
            f"{settings['default']['experts']}. Framed: the default.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _amounts(result: Mapping, agent: str, **changed) -> Mapping:
    wanted = {**result["settings"]["default"], "agent": agent, **changed}
    return next(r for r in result["rows"] if "mean" in r and all(r[k] == v for k, v in wanted.items()))


def _draw_amounts(axes: "Axes", result: Mapping, heeds: bool) -> None:
    settings = result["settings"]
    shift = 0.004 * settings["kappas"][-1]
    for place, agent in enumerate(_FIXED):
        row = _amounts(result, agent, heeds=heeds)
        x = np.array(settings["kappas"]) + (place - 2) * shift
        axes.errorbar(
            x, row["mean"], row["deviation"], color=AGENTS[agent], label=NAMES[agent], lw=1.6,
            elinewidth=0.8, marker="o", ms=3,
        )  # fmt: skip
    axes.axvline(settings["kappa"], color=GREY, lw=0.9, ls=(0, (4, 3)))
    axes.set(xlabel="κ (nats)", ylim=(0, 104))
    axes.grid(axis="y", color=LIGHT)
    axes.set_title("Agents who follow advice" if heeds else "Agents who are only watched")


def _draw_ceiling(axes: "Axes", result: Mapping) -> None:
    settings = result["settings"]
    for row in result["rows"]:
        if "ceiling" in row and row["loops"] == settings["default"]["loops"]:
            shares = 100 * np.array(row["ceiling"])
            colour = _EXPERTS[row["experts"]]
            axes.plot(settings["kappas"], shares, "o-", color=colour, ms=3, lw=1.6, label=row["experts"])
    axes.axvline(settings["kappa"], color=GREY, lw=0.9, ls=(0, (4, 3)))
    for ways in (1, 2, 3):
        axes.axvline(np.log(4 / ways), color=INK, lw=0.8, ls=(0, (1, 2)))
        axes.annotate(
            f"log 4/{ways}", (np.log(4 / ways), 0), (3, 4), xycoords=("data", "axes fraction"),
            textcoords="offset points", rotation=90, ha="left", va="bottom", fontsize=7, color=GREY,
        )  # fmt: skip
    axes.set(xlabel="κ (nats)", ylabel="states (%)", ylim=(0, 104))
    axes.grid(axis="y", color=LIGHT)
    axes.legend(loc="lower left", bbox_to_anchor=(0, 0.1), title="experts", title_fontsize=8)
    axes.set_title("Ceiling: states where advice is possible at all")


def _draw_learning(axes: "Axes", result: Mapping) -> None:
    settings = result["settings"]
    k = settings["kappas"].index(settings["kappa"])
    rows = [_amounts(result, f"q {episodes}") for episodes in settings["snapshots"]]
    mean, deviation = ([row[key][k] for row in rows] for key in ("mean", "deviation"))
    axes.errorbar(
        settings["snapshots"], mean, deviation, color=AGENTS["q-learning"], marker="o", ms=3.5, elinewidth=0.8,
        label="Q-learning so far",
    )  # fmt: skip
    for agent in ("random", "optimal"):
        level = _amounts(result, agent)["mean"][k]
        axes.axhline(level, color=AGENTS[agent], lw=1.2, ls=(0, (4, 2)), label=NAMES[agent])
    axes.set(xscale="log", xlabel="episodes learnt", ylabel="advised steps in 100")
    axes.set_ylim(bottom=0)
    axes.xaxis.set_major_formatter("{x:g}")
    axes.grid(axis="y", color=LIGHT)
    axes.legend(loc="lower left", bbox_to_anchor=(0, 0.0), frameon=True, framealpha=1, edgecolor="none")
    axes.set_title(f"Q-learning at κ = {settings['kappa']:g}")


def _draw_grid(axes: "Axes", result: Mapping) -> None:
    settings, default = result["settings"], result["settings"]["default"]
    columns = [(loops, experts) for loops in settings["loops"] for experts in settings["experts"]]
    heads = [f"{EXPERT_NAMES[experts]}\n{loops:g}" for loops, experts in columns]
    k = settings["kappas"].index(settings["kappa"])
    agents = [*_FIXED, f"q {settings['snapshots'][0]}", f"q {settings['snapshots'][-1]}"]
    values = [[_amounts(result, a, loops=n, experts=e)["mean"][k] for n, e in columns] for a in agents]
    sides = [*(NAMES[a] for a in _FIXED), *(f"Q-learning, {a[2:]} ep." for a in agents[len(_FIXED) :])]
    draw_heat_grid(
        axes, values, np.zeros(np.shape(values), bool), sides, heads, neutral=0.0, spread=100.0,
        words="{:.0f}".format,
    )  # fmt: skip
    framed = columns.index((default["loops"], default["experts"]))
    axes.axvspan(framed - 0.5, framed + 0.5, fill=False, ec=INK, lw=1.6, zorder=3)
    axes.set_title(f"Advised steps in 100 at κ = {settings['kappa']:g}")
    axes.set_xlabel("experts, and share of walls opened into loops")
