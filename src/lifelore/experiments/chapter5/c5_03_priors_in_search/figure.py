"""Figure of claim C5.3: what an action prior does for tree search, depth-first search and bandits."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.figures.style import BLUE, GREEN, GREY, INK, LIGHT, PAPER, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_guided_choices(result)


_COLOURS = {"place": BLUE, "percept": GREEN}
_KINDS = {"place": "places, other goals of the maze", "percept": "percepts, other mazes"}
_WAYS = {
    ("tree and rollouts", "most tried"): ("o", True, "tree and rollouts"),
    ("tree", "most tried"): ("o", False, "tree alone"),
    ("tree and rollouts", "best mean"): ("D", True, "tree and rollouts, move of best mean"),
}
_INDICES = {"ucb1": "UCB1", "beta": "Thompson, Beta", "gaussian": "Thompson, normal"}
_STARTS = {"flat": GREY, "even": VERMILION}
_START_WORDS = {"flat": "flat start", "even": "pseudo-counts spread evenly"}


def draw_guided_choices(result: Mapping) -> "Figure":
    """The figure from the result of C5.3."""
    settings, rows = result["settings"], result["rows"]
    simulations = settings["simulations"]
    with house_style():
        figure = new_figure(11.4, 8.6)
        upper, lower = figure.subfigures(2, 1, squeeze=False, height_ratios=[1.25, 1.0], hspace=0.03)[:, 0]
        *searches, ordered = upper.subplots(1, len(simulations) + 1, squeeze=False)[0]
        for axes, n in zip(searches, simulations, strict=True):
            _draw_gains(axes, settings, [row for row in rows if row["use"] == "search"], n)
        _share_limits(searches)
        _draw_orders(ordered, settings, [row for row in rows if row["use"] == "depth first"])
        for axes in searches[1:]:
            axes.set_yticklabels([])
        upper.legend(*searches[0].get_legend_handles_labels(), loc="outside upper left", ncols=2)
        panels = lower.subplots(1, len(_INDICES), sharey=True)
        curves = [row for row in rows if row["use"] == "curve"]
        for axes, index in zip(panels, _INDICES, strict=True):
            _draw_regret(axes, settings, [row for row in curves if row["index"] == index], index)
        panels[0].set_ylabel("regret so far")
        lower.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=4)
        lower.supxlabel(
            f"{settings['mazes']} mazes, a held-out goal each. Bars: 95 % intervals, paired by maze; bands: 95 %. "
            f"Bandits: {settings['strength']:g} pseudo-pulls an arm, form proportion.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _draw_gains(axes: "Axes", settings: Mapping, rows: Sequence[Mapping], n: int) -> None:
    """Share more than without the prior: forms downwards, a colour a kind, a mark a way of guiding."""
    rows = [row for row in rows if row["simulations"] == n]
    plain = {row["move"]: f"{100 * row['success']['value']:.0f} %" for row in rows if row["kind"] is None}
    ways = [(kind, *way) for kind in _KINDS for way in _WAYS]
    for nth, (kind, *way) in enumerate(ways):
        mine = [row for row in rows if [row["kind"], row["guides"], row["move"]] == [kind, *way]]
        gain_of = {row["form"]: row["gain"] for row in mine}
        gains = [gain_of[form] for form in settings["forms"]]
        mark, filled, words = _WAYS[way[0], way[1]]
        at = np.arange(len(gains)) + 0.13 * (nth - 2.5)
        label = f"{_KINDS[kind]}: {words}"
        _draw_points(axes, gains, at, _COLOURS[kind], label, 100.0, mark, filled)
    axes.axvline(0, color=INK, lw=1.0, zorder=1)
    axes.set_title(f"Tree search, {n} simulations")
    without = f"without prior: {plain['most tried']}, by best mean {plain['best mean']}"
    axes.set_xlabel(f"more goals reached (points)\n{without}")
    _name_rows(axes, settings["forms"])


def _draw_orders(axes: "Axes", settings: Mapping, rows: Sequence[Mapping]) -> None:
    """Nodes expanded as a ratio to a random order's: depth first by form, then deepened and pruned."""
    forms = [("depth first", form) for form in settings["forms"]]
    wanted = [*forms, ("deepening", "proportion"), ("pruned", "proportion")]
    ratio_of = {(row["search"], row["form"], row["kind"]): row for row in rows}
    for nth, kind in enumerate(_KINDS):
        found = [ratio_of[*way, kind]["ratio"] for way in wanted]
        at = np.arange(len(wanted)) + 0.24 * (nth - 0.5)
        _draw_points(axes, found, at, _COLOURS[kind], _KINDS[kind], 1.0)
    axes.axvline(1, color=INK, lw=1.0, zorder=1)
    axes.set_title("Depth-first search")
    axes.set_xlabel("nodes expanded / random order's")
    axes.set_xlim(left=0)
    shares = [100 * ratio_of["pruned", "proportion", kind]["reached"]["value"] for kind in _KINDS]
    pruned = f"pruned\n(finds {shares[0]:.0f}, {shares[1]:.0f} %)"
    _name_rows(axes, [*settings["forms"], "deepening", pruned])
    axes.axhline(len(forms) - 0.5, color=LIGHT, lw=1.0)


def _draw_points(
    axes: "Axes",
    found: Sequence[Mapping],
    at: np.ndarray,
    colour: str,
    label: str,
    scale: float,
    mark: str = "o",
    filled: bool = True,
) -> None:
    values = [scale * number["value"] for number in found]
    for place, number in zip(at, found, strict=True):
        if number["ci95"]:
            axes.plot([scale * end for end in number["ci95"]], [place, place], color=colour, lw=1.3, zorder=2)
    face = colour if filled else PAPER
    axes.plot(values, at, mark, ms=4.5, ls="", color=colour, mfc=face, mew=1.2, label=label, zorder=3)


def _name_rows(axes: "Axes", names: Sequence[str]) -> None:
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.45, -0.55)
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    axes.grid(axis="x", color=LIGHT)


def _share_limits(panels: Sequence["Axes"]) -> None:
    ends = np.array([axes.get_xlim() for axes in panels])
    for axes in panels:
        axes.set_xlim(ends[:, 0].min(), ends[:, 1].max())


def _draw_regret(axes: "Axes", settings: Mapping, rows: Sequence[Mapping], index: str) -> None:
    for row in rows:
        colour = _COLOURS[row["kind"]] if row["kind"] else _STARTS[row["form"]]
        label = _KINDS[row["kind"]] if row["kind"] else _START_WORDS[row["form"]]
        mean, half = np.array(row["mean"]), 1.96 * np.array(row["error"])
        pulls = np.unique(np.linspace(0, settings["pulls"] - 1, len(mean)).astype(int)) + 1
        axes.fill_between(pulls, mean - half, mean + half, color=colour, alpha=0.18, lw=0)
        axes.plot(pulls, mean, color=colour, label=label)
    axes.set_title(_INDICES[index])
    axes.set_xlabel("pulls")
    axes.set_ylim(bottom=0)
    axes.grid(axis="y", color=LIGHT)
