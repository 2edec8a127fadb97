"""How long pictures take: each picture a dot on a scale of seconds, and the median of each stage of the way."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.core.errors import InputError
from lifelore.figures.style import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PURPLE, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    whole = {row["images"]: row["seconds"] for row in result["rows"] if "seconds" in row}
    stages = {
        kind: {
            row["stage"]: row["median_ms"]
            for row in result["rows"]
            if row.get("images") == kind and "stage" in row
        }
        for kind in whole
    }
    return draw_stage_times(whole, stages, marks={"half a second": 0.5, "a second": 1.0})


_COLOURS = (BLUE, ORANGE, GREEN, PURPLE)


def draw_stage_times(
    whole: Mapping[str, Sequence[float]],
    stages: Mapping[str, Mapping[str, float]],
    marks: Mapping[str, float] | None = None,
) -> "Figure":
    """The figure.

    Parameters
    ----------
    whole : mapping of kind to (n,) floats
        Seconds of every picture of a kind.
    stages : mapping of kind to mapping of stage to float
        Median milliseconds; the same kinds, stages in the order of the first.
    marks : mapping of name to float, optional
        Seconds marked by a line.

    Raises
    ------
    InputError
        There is no kind, a kind has no picture, or the two name different kinds.
    """
    if not whole or set(whole) != set(stages) or not all(len(seconds) for seconds in whole.values()):
        raise InputError(
            f"whole and stages must name the same kinds, each with a picture, got {[*whole]}, {[*stages]}"
        )
    colours = {kind: _COLOURS[place % len(_COLOURS)] for place, kind in enumerate(whole)}
    with house_style():
        figure = new_figure(10.4, 3.3)
        left, right = figure.subplots(1, 2)
        _dots(left, whole, colours, marks or {})
        _bars(right, stages, colours)
    return figure


def _dots(
    axes: "Axes", whole: Mapping[str, Sequence[float]], colours: Mapping[str, str], marks: Mapping[str, float]
) -> None:
    for place, (kind, seconds) in enumerate(whole.items()):
        ordered = np.sort(np.asarray(seconds, float))
        # Ranks spread the dots, so that a crowd shows as a slope and not as a blot.
        height = place + 0.3 - 0.6 * (np.arange(len(ordered)) + 0.5) / len(ordered)
        axes.scatter(ordered, height, s=14, color=colours[kind], alpha=0.75, linewidths=0, zorder=3)
        middle = float(np.median(ordered))
        axes.plot([middle] * 2, [place - 0.36, place + 0.36], color=INK, lw=1.2, zorder=2)
    for name, at in marks.items():
        axes.axvline(at, color=GREY, lw=1, ls=(0, (4, 3)), zorder=1)
        axes.annotate(
            name, (at, 1), (-3, -2), xycoords=("data", "axes fraction"), textcoords="offset points",
            ha="right", va="top", fontsize=7.5, color=GREY, rotation=90,
        )  # fmt: skip
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set_yticks(
        range(len(whole)),
        [f"{kind}\nmedian {1000 * np.median(seconds):.0f} ms" for kind, seconds in whole.items()],
    )
    axes.set_ylim(len(whole) - 0.45, -0.55)
    axes.set(xlabel="seconds of a picture", title="the whole way, picture by picture")
    axes.grid(axis="x", color=LIGHT)


def _bars(axes: "Axes", stages: Mapping[str, Mapping[str, float]], colours: Mapping[str, str]) -> None:
    names = list(next(iter(stages.values())))
    height = 0.8 / len(stages)
    for number, (kind, times) in enumerate(stages.items()):
        places = np.arange(len(names)) - 0.4 + height * (number + 0.5)
        axes.barh(places, [times[name] for name in names], height=height, color=colours[kind], label=kind)
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.set(xlabel="median milliseconds of a stage")
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x", color=LIGHT)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(stages), borderaxespad=0.2)
