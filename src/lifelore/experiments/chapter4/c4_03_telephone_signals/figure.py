"""Regret on the telephone by kind of signal, with the calls' transition system (C4.3; Figures 4.5 and 4.6)."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter4.c4_03_telephone_signals.figure_call_graph import fill_call_graph
from lifelore.experiments.chapter4.reuse_palette import look_of
from lifelore.figures.style import LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_telephone_curves(result)


SIGNALS = ("(s, a, s′)", "(s, a, r)", "U")
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


def draw_telephone_curves(result: Mapping) -> "Figure":
    """From C4.3's result: regret by call and signal for learnt and exact models, and sums by number of models."""
    rows, settings = result["rows"], result["settings"]
    with house_style():
        figure = new_figure(11.2, 6.6)
        top, bottom = figure.subplots(2, 2, height_ratios=[1, 1])
        fill_call_graph(top[0], EDGES, fontsize=7)
        top[0].set_title("A call (reading A)")
        _draw_sums(top[1], rows, settings)
        for axes, model in zip(bottom, ("exact", "learnt"), strict=True):
            _draw_curves(axes, [r for r in rows if _shown(r, "A", settings["default_models"], model, settings)])
            words = (
                "exact models" if model == "exact" else f"models learnt from {settings['samples']} calls a pair"
            )
            axes.set_title(f"{settings['default_models']} language models, {words}")
        bottom[0].set_ylabel("regret of a call: mean, and + deviation")
        handles, labels = bottom[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return figure


def _draw_curves(axes: "Axes", rows: list[Mapping]) -> None:
    for row in rows:
        colour, style = look_of(row["signal"])
        mean, deviation = np.array(row["mean"]), np.array(row["deviation"])
        calls = np.arange(1, len(mean) + 1)
        wide = 1.8 if row["signal"] == SIGNALS[0] else 1.0  # the first two nearly coincide
        axes.plot(calls, mean, color=colour, ls=style, lw=2 * wide, label=row["signal"])
        axes.plot(calls, mean + deviation, color=colour, lw=0.8 * wide, alpha=0.6)
    axes.set(xlabel="call", ylim=(0, None), xlim=(1, None))
    axes.grid(axis="y", color=LIGHT)


def _draw_sums(axes: "Axes", rows: list[Mapping], settings: Mapping) -> None:
    """Regret over all calls: dots for means, bars for a deviation to either side."""
    places, names = [], []
    for i, n in enumerate(settings["models"]):
        for j, model in enumerate(("exact", "learnt")):
            centre = 2.4 * i + j
            places.append(centre)
            names.append(f"{n}\n{model}")
            for k, signal in enumerate(SIGNALS):
                row = next(
                    r for r in rows
                    if _shown(r, "A", n, model, settings) and r["signal"] == signal
                )  # fmt: skip
                colour, _ = look_of(signal)
                x, mean = centre + 0.25 * (k - 1), row["cumulative"]["value"]
                axes.plot([x, x], [mean, mean + row["deviation_of_sum"]], color=colour, lw=1.4)
                axes.plot([x], [mean], "o", color=colour, ms=4.5)
    axes.set_xticks(places, names, fontsize=7.5)
    axes.set(title=f"Regret over {settings['calls']} calls, + deviation, by number of models", ylim=(0, None))
    axes.grid(axis="y", color=LIGHT)


def _shown(row: Mapping, reading: str, n: int, model: str, settings: Mapping) -> bool:
    samples = None if model == "exact" else settings["samples"]
    return (row["reading"], row["models"], row["samples"]) == (reading, n, samples)
