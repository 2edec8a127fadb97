"""Regret on the telephone by kind of signal, with the calls' transition system (Figures 4.5 and 4.6)."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.curves import draw_curves
from lifelore.figures.style import BLUE, GREY, INK, LIGHT, PAPER, Axes, Figure, house_style, new_figure
from reproduction.chapter4.c4_03_telephone_signals.run import SIGNALS
from reproduction.chapter4.reuse.looks import lines_of, look_of
from reproduction.chapter4.reuse.many_tasks import EXACT, LEARNT, UNCERTAIN
from reproduction.engine.results_table import ResultsTable

PLACES = {
    "start": (0.0, 0.0),
    "frustrated": (3.8, 0.0),
    "annoyed": (7.6, 0.0),
    "angry": (10.4, 0.0),
    "success": (5.7, 2.5),
    "hung up": (5.7, -2.5),
}
_ENDS = ("angry", "success", "hung up")
_RADIUS = 0.62
_SHARE = {"start": 0.42, "frustrated": 0.36, "annoyed": 0.66}
"""Where along an edge to success or hung up its label stands, by the state it leaves."""
_PATH = ("start", "frustrated", "annoyed")
EDGES = {
    (state, after): (words, reward)
    for k, state in enumerate(_PATH)
    for after, words, reward in (
        ((*_PATH, "angry")[k + 1], "η", 1.0),
        ("success", "(1−η)ρ", 10.0 - k),
        ("hung up", "(1−η)(1−ρ)", 3.0 - k),
    )
}
"""The transition system of reading A."""


def draw(result: Mapping) -> Figure:
    settings = result["settings"]
    keys = ("reading", "models", "model", "samples", "signal")
    table = ResultsTable(result["rows"], keys).select(reading="A")
    few = settings["samples"]
    kinds = {EXACT: None, LEARNT: few}
    n = settings["default_models"]
    words = {
        EXACT: f"{n} language models, exact models",
        LEARNT: f"models learnt from {few} calls a pair",
        UNCERTAIN: "the same, known to be uncertain",
    }
    with house_style():
        figure = new_figure(12.4, 6.6)
        grid = figure.add_gridspec(2, 6)
        top = [figure.add_subplot(grid[0, 3 * i : 3 * i + 3]) for i in range(2)]
        bottom = [figure.add_subplot(grid[1, 2 * i : 2 * i + 2]) for i in range(3)]
        draw_call_graph(top[0], EDGES)
        top[0].set_title("A call (reading A)")
        _draw_sums(top[1], table, settings, kinds)
        for axes, (kind, title) in zip(bottom, words.items(), strict=True):
            _draw_regret(axes, table.select(models=n, model=kind, samples=kinds.get(kind, few)), title)
        bottom[0].set_ylabel("regret of a call: mean, and + deviation")
        figure.legend(*bottom[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _draw_regret(axes: Axes, table: ResultsTable, title: str) -> None:
    """Means, and thinner a deviation above them."""
    thick = lines_of(SIGNALS, linewidth=2)
    thick[SIGNALS[0]]["linewidth"] = 3.6  # the first two nearly coincide
    mean = {row["signal"]: {"mean": row["mean"]} for row in table.records}
    above = {f"_{row['signal']}": {"mean": np.add(row["mean"], row["deviation"])} for row in table.records}
    thin = {f"_{name}": look for name, look in lines_of(SIGNALS, linewidth=0.8, alpha=0.6).items()}
    draw_curves(axes, None, mean | above, looks=thick | thin, title=title, xlabel="call", legend=False)
    axes.set(ylim=(0, None), xlim=(1, None))
    axes.grid(axis="y", color=LIGHT)


def _draw_sums(axes: Axes, table: ResultsTable, settings: Mapping, kinds: Mapping) -> None:
    """Regret over all calls: dots for means, lines up to a deviation above them."""
    places: dict[float, str] = {}
    for i, n in enumerate(settings["models"]):
        for j, (kind, samples) in enumerate(kinds.items()):
            places[2.4 * i + j] = f"{n}\n{kind}"
            for k, signal in enumerate(SIGNALS):
                row = table.record(models=n, model=kind, samples=samples, signal=signal)
                x, mean, colour = 2.4 * i + j + 0.25 * (k - 1), row["cumulative"]["value"], look_of(signal)[0]
                axes.plot([x, x], [mean, mean + row["deviation_of_sum"]], color=colour, lw=1.4)
                axes.plot([x], [mean], "o", color=colour, ms=4.5)
    axes.set_xticks(list(places), list(places.values()), fontsize=7.5)
    axes.set(title=f"Regret over {settings['calls']} calls, + deviation, by number of models", ylim=(0, None))
    axes.grid(axis="y", color=LIGHT)


def draw_call_graph(axes: Axes, edges: Mapping[tuple[str, str], tuple[str, float]], fontsize: float = 7) -> None:
    """Draw states as circles, those that end the call with a thick rim.

    `edges`: (state, next state) to the name of its probability and its reward.
    """
    from matplotlib.patches import Circle

    for (start, end), (probability, reward) in edges.items():
        _draw_edge(axes, start, end, probability, f"[{reward:g}]", fontsize)
    for name, place in PLACES.items():
        axes.add_patch(Circle(place, _RADIUS, fc=PAPER, ec=INK, lw=3 if name in _ENDS else 1.2, zorder=3))
        axes.text(*place, name, ha="center", va="center", fontsize=fontsize - 1, zorder=4)
    axes.set(xlim=(-0.9, 11.3), ylim=(-3.25, 3.25), aspect="equal")
    axes.axis("off")


def _draw_edge(axes: Axes, start: str, end: str, probability: str, reward: str, fontsize: float) -> None:
    place, way = np.array(PLACES[start]), np.subtract(PLACES[end], PLACES[start])
    step = way / np.hypot(*way)
    tail, head = place + _RADIUS * step, place + way - (_RADIUS + 0.04) * step
    arrow = {"arrowstyle": "-|>", "color": GREY, "lw": 1.1, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", head, tail, arrowprops=arrow, zorder=2)
    level = way[1] == 0
    # Nearer the start, where edges to the same state have not yet met; each at a height of its own.
    x, y = tail + (0.5 if level else _SHARE[start]) * (head - tail)
    label = f"{probability}\n{reward}" if level else f"{probability} {reward}"
    axes.text(
        x, y, label, color=BLUE, ha="center", va="center", fontsize=fontsize, zorder=2.5, linespacing=1.6,
        bbox={"boxstyle": "round,pad=0.12", "fc": "none" if level else PAPER, "ec": "none"},
    )  # fmt: skip
