"""Figure of claim C5.3: what an action prior does for tree search, depth-first search and bandits."""

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from lifelore.figures.curves import draw_curves
from lifelore.figures.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    LIGHT,
    PAPER,
    VERMILION,
    house_style,
    new_figure,
    two_rows,
)
from reproduction.engine.results_table import ResultsTable

KINDS = {"place": ("places, other goals of the maze", BLUE), "percept": ("percepts, other mazes", GREEN)}
WAYS = {
    ("tree and rollouts", "most tried"): ("o", True, "tree and rollouts"),
    ("tree", "most tried"): ("o", False, "tree alone"),
    ("tree and rollouts", "best mean"): ("D", True, "tree and rollouts, move of best mean"),
}
INDICES = {"ucb1": "UCB1", "beta": "Thompson, Beta", "gaussian": "Thompson, normal"}
STARTS = {"flat": ("flat start", GREY), "even": ("pseudo-counts spread evenly", VERMILION)}


def draw(result: Mapping):
    """Tree and depth-first search above, bandits below."""
    settings = result["settings"]
    table = ResultsTable(
        result["rows"], ("use", "kind", "form", "guides", "move", "simulations", "search", "index")
    )
    with house_style():
        figure = new_figure(11.4, 8.6)
        upper, lower = two_rows(figure, (1.25, 1.0))
        *searches, ordered = upper.subplots(1, len(settings["simulations"]) + 1, squeeze=False)[0]
        for axes, n in zip(searches, settings["simulations"], strict=True):
            if n != settings["simulations"][0]:
                axes.sharex(searches[0])
            _draw_gains(axes, settings["forms"], table.select(use="search", simulations=n), n)
        for axes in searches[1:]:
            axes.tick_params(labelleft=False)
        _draw_orders(ordered, settings["forms"], table.select(use="depth first"))
        upper.legend(*searches[0].get_legend_handles_labels(), loc="outside upper left", ncols=2)
        panels = lower.subplots(1, len(INDICES), sharey=True)
        for axes, index in zip(panels, INDICES, strict=True):
            _draw_regret(axes, settings["pulls"], table.select(use="curve", index=index).records, INDICES[index])
        panels[0].set_ylabel("regret so far")
        lower.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=4)
        lower.supxlabel(
            f"{settings['mazes']} mazes, a held-out goal each. Bars: 95 % intervals, paired by maze; bands: 95 %. "
            f"Bandits: {settings['strength']:g} pseudo-pulls an arm, form proportion.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _draw_gains(axes, forms: Sequence[str], table: ResultsTable, n: int) -> None:
    """Share more than without the prior: forms downwards, a colour a kind, a mark a way of guiding."""
    for nth, (kind, (guides, move)) in enumerate(product(KINDS, WAYS)):
        gains = [table.record(kind=kind, form=form, guides=guides, move=move)["gain"] for form in forms]
        (mark, filled, words), (name, colour) = WAYS[guides, move], KINDS[kind]
        at = np.arange(len(forms)) + 0.13 * (nth - 2.5)
        _draw_points(
            axes, gains, at, 100.0, mark, colour, mfc=colour if filled else PAPER, label=f"{name}: {words}"
        )
    tried, mean = (100 * table.record(kind=None, move=m)["success"]["value"] for m in ("most tried", "best mean"))
    without = f"without prior: {tried:.0f} %, by best mean {mean:.0f} %"
    axes.set(title=f"Tree search, {n} simulations", xlabel=f"more goals reached (points)\n{without}")
    _name_rows(axes, forms, 0)


def _draw_orders(axes, forms: Sequence[str], table: ResultsTable) -> None:
    """Nodes expanded as a ratio to a random order's: depth first by form, then deepened and pruned."""
    wanted = [("depth first", form) for form in forms] + [("deepening", "proportion"), ("pruned", "proportion")]
    for nth, (kind, (_, colour)) in enumerate(KINDS.items()):
        ratios = [table.record(search=search, form=form, kind=kind)["ratio"] for search, form in wanted]
        _draw_points(axes, ratios, np.arange(len(wanted)) + 0.24 * (nth - 0.5), 1.0, "o", colour)
    axes.set(title="Depth-first search", xlabel="nodes expanded / random order's", xlim=(0, None))
    place, percept = (100 * table.record(search="pruned", kind=kind)["reached"]["value"] for kind in KINDS)
    _name_rows(axes, [*forms, "deepening", f"pruned\n(finds {place:.0f}, {percept:.0f} %)"], 1)
    axes.axhline(len(forms) - 0.5, color=LIGHT, lw=1.0)


def _draw_points(axes, numbers: Sequence[Mapping], at: np.ndarray, scale: float, mark: str, colour: str, **look):
    for place, number in zip(at, numbers, strict=True):
        if number["ci95"]:
            axes.plot([scale * end for end in number["ci95"]], [place, place], color=colour, lw=1.3, zorder=2)
    values = [scale * number["value"] for number in numbers]
    axes.plot(values, at, mark, ms=4.5, ls="", color=colour, mew=1.2, zorder=3, **look)


def _name_rows(axes, names: Sequence[str], neutral: float) -> None:
    axes.axvline(neutral, color=INK, lw=1.0, zorder=1)
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.45, -0.55)
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    axes.grid(axis="x", color=LIGHT)


def _draw_regret(axes, pulls: int, rows: Sequence[Mapping], title: str) -> None:
    series, looks = {}, {}
    for row in rows:
        label, colour = KINDS[row["kind"]] if row["kind"] else STARTS[row["form"]]
        series[label] = {"mean": row["mean"], "error": 1.96 * np.array(row["error"])}
        looks[label] = {"color": colour}
    x = np.unique(np.linspace(0, pulls - 1, len(rows[0]["mean"])).astype(int)) + 1
    draw_curves(axes, x, series, looks=looks, title=title, xlabel="pulls", legend=False)
    axes.set_ylim(bottom=0)
    axes.grid(axis="y", color=LIGHT)
