"""Seconds of each picture as a dot, and the median of each stage as a bar."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.scatter import draw_scatter
from lifelore.figures.style import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, house_style, new_figure
from reproduction.chapter2.c2_04_time_per_image.measure import NAMES

MARKS = {"half a second": 0.5, "a second": 1.0}
COLOURS = dict(zip(NAMES, (BLUE, ORANGE, GREEN), strict=True))


def draw(result: Mapping):
    seconds = {row["images"]: np.array(row["seconds"]) for row in result["rows"] if "seconds" in row}
    points = {kind: result["measured"][f"points_{name}"]["median"] for kind, name in NAMES.items()}
    stages = [row for row in result["rows"] if "stage" in row]
    names = list(dict.fromkeys(row["stage"] for row in stages))
    with house_style():
        figure = new_figure(10.4, 3.3)
        left, right = figure.subplots(1, 2)
        draw_seconds(left, seconds, points)
        bars = {kind: [{"value": row["median_ms"]} for row in stages if row["images"] == kind] for kind in seconds}
        draw_interval_bars(
            right, names, bars, colours=COLOURS, words=None, label="median milliseconds of a stage", legend=False
        )
        right.grid(axis="x", color=LIGHT)
        right.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(seconds), borderaxespad=0.2)
    return figure


def draw_seconds(axes, seconds: Mapping[str, np.ndarray], points: Mapping[str, float]) -> None:
    """A dot for each picture by kind, spread by rank; a line at the median and at each of `MARKS`."""
    for place, (kind, times) in enumerate(seconds.items()):
        # Ranks spread the dots, so that a crowd shows as a slope and not as a blot.
        height = place + 0.3 - 0.6 * (np.arange(len(times)) + 0.5) / len(times)
        dots = np.column_stack([np.sort(times), height])
        draw_scatter(axes, {kind: dots}, colours=COLOURS, size=14, through_zero=False)
        axes.plot([float(np.median(times))] * 2, [place - 0.36, place + 0.36], color=INK, lw=1.2, zorder=0.5)
    for name, at in MARKS.items():
        axes.axvline(at, color=GREY, lw=1, ls=(0, (4, 3)), zorder=0.5)
        axes.annotate(
            name, (at, 1), (-3, -2), xycoords=("data", "axes fraction"), textcoords="offset points",
            ha="right", va="top", fontsize=7.5, color=GREY, rotation=90,
        )  # fmt: skip
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:g}")
    words = [f"{kind}\n{points[kind]:,.0f} points\n{1000 * np.median(t):.0f} ms" for kind, t in seconds.items()]
    axes.set_yticks(range(len(seconds)), words)
    axes.set_ylim(len(seconds) - 0.45, -0.55)
    axes.set(xlabel="seconds of a picture (line: median)", title="from points to relations, picture by picture")
    axes.grid(axis="x", color=LIGHT)
