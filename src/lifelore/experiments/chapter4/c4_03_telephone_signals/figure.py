"""Regret on the telephone by kind of signal, with the calls' transition system (Figures 4.5 and 4.6)."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter4.c4_03_telephone_signals.run import SIGNALS
from lifelore.experiments.chapter4.reuse_figures import lines_of, look_of
from lifelore.experiments.engine.results_table import ResultsTable
from lifelore.figures.curves import draw_curves
from lifelore.figures.style import BLUE, GREY, INK, LIGHT, PAPER, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PLACES = {
    "start": (0.0, 0.0),
    "frustrated": (2.6, 0.0),
    "annoyed": (5.2, 0.0),
    "angry": (7.8, 0.0),
    "success": (3.9, 2.1),
    "hung up": (3.9, -2.1),
}
_ENDS = ("angry", "success", "hung up")
_RADIUS = 0.62
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


def draw(result: Mapping) -> "Figure":
    """The transition system, sums by number of models, and regret by call for exact and learnt models."""
    settings = result["settings"]
    table = ResultsTable(result["rows"], ("reading", "models", "samples", "signal")).select(reading="A")
    kinds = {"exact": None, "learnt": settings["samples"]}
    words = {"exact": "exact models", "learnt": f"models learnt from {settings['samples']} calls a pair"}
    n = settings["default_models"]
    with house_style():
        figure = new_figure(11.2, 6.6)
        top, bottom = figure.subplots(2, 2)
        draw_call_graph(top[0], EDGES)
        top[0].set_title("A call (reading A)")
        _draw_sums(top[1], table, settings, kinds)
        for axes, (kind, samples) in zip(bottom, kinds.items(), strict=True):
            own = table.select(models=n, samples=samples)
            _draw_regret(axes, own, f"{n} language models, {words[kind]}")
        bottom[0].set_ylabel("regret of a call: mean, and + deviation")
        figure.legend(*bottom[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _draw_regret(axes: "Axes", table: ResultsTable, title: str) -> None:
    mean, above = {}, {}
    for row in table.records:
        mean[row["signal"]] = {"mean": row["mean"]}
        above[row["signal"]] = {"mean": np.array(row["mean"]) + row["deviation"]}
    looks = lines_of(SIGNALS, linewidth=2)
    looks[SIGNALS[0]]["linewidth"] = 3.6  # the first two nearly coincide
    draw_curves(axes, None, mean, looks=looks, title=title, xlabel="call", legend=False)
    handles = axes.get_lines()
    draw_curves(axes, None, above, looks=lines_of(SIGNALS, linewidth=0.8, alpha=0.6), title=title, legend=False)
    for line in axes.get_lines()[len(handles) :]:
        line.set_label(None)
    axes.set(xlabel="call", ylim=(0, None), xlim=(1, None))
    axes.grid(axis="y", color=LIGHT)


def _draw_sums(axes: "Axes", table: ResultsTable, settings: Mapping, kinds: Mapping) -> None:
    """Regret over all calls: dots for means, lines up to a deviation above them."""
    places: dict[float, str] = {}
    for i, n in enumerate(settings["models"]):
        for j, (kind, samples) in enumerate(kinds.items()):
            places[2.4 * i + j] = f"{n}\n{kind}"
            for k, signal in enumerate(SIGNALS):
                row = table.record(models=n, samples=samples, signal=signal)
                x, mean, colour = 2.4 * i + j + 0.25 * (k - 1), row["cumulative"]["value"], look_of(signal)[0]
                axes.plot([x, x], [mean, mean + row["deviation_of_sum"]], color=colour, lw=1.4)
                axes.plot([x], [mean], "o", color=colour, ms=4.5)
    axes.set_xticks(list(places), list(places.values()), fontsize=7.5)
    axes.set(title=f"Regret over {settings['calls']} calls, + deviation, by number of models", ylim=(0, None))
    axes.grid(axis="y", color=LIGHT)


def draw_call_graph(axes: "Axes", edges: Mapping[tuple[str, str], tuple[str, float]], fontsize: float = 7) -> None:
    """Draw states as circles, those that end the call with a thick rim.

    `edges`: (state, next state) to the name of its probability and its reward.
    """
    from matplotlib.patches import Circle

    for (start, end), (probability, reward) in edges.items():
        _draw_edge(axes, start, end, probability, f"[{reward:g}]", fontsize)
    for name, (x, y) in PLACES.items():
        thick = name in _ENDS
        axes.add_patch(Circle((x, y), _RADIUS, fc=PAPER, ec=INK, lw=3 if thick else 1.2, zorder=3))
        axes.text(x, y, name, ha="center", va="center", fontsize=fontsize - 1, zorder=4)
    axes.set(xlim=(-0.9, 8.7), ylim=(-2.95, 2.95), aspect="equal")
    axes.axis("off")


def _draw_edge(axes: "Axes", start: str, end: str, probability: str, reward: str, fontsize: float) -> None:
    (x0, y0), (x1, y1) = PLACES[start], PLACES[end]
    length = ((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5
    dx, dy = (x1 - x0) / length, (y1 - y0) / length
    tail = (x0 + dx * _RADIUS, y0 + dy * _RADIUS)
    head = (x1 - dx * (_RADIUS + 0.04), y1 - dy * (_RADIUS + 0.04))
    arrow = {"arrowstyle": "-|>", "color": GREY, "lw": 1.1, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", head, tail, arrowprops=arrow, zorder=2)
    # Nearer the start, where edges to one state have not yet met.
    share = 0.5 if dy == 0 else 0.52 if start == "frustrated" else 0.34
    x, y = tail[0] + share * (head[0] - tail[0]), tail[1] + share * (head[1] - tail[1])
    box = {"boxstyle": "round,pad=0.12", "fc": PAPER, "ec": "none"}
    above = 0.28 if dy == 0 else 0.17
    axes.text(
        x, y + above, probability, color=BLUE, ha="center", va="center", fontsize=fontsize, bbox=box, zorder=2.5
    )
    axes.text(
        x, y - above, reward, color=INK, ha="center", va="center", fontsize=fontsize - 2, bbox=box, zorder=2.5
    )
