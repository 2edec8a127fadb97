"""How well things in each role are found by several methods, with pictures of a few scenes."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.experiments.chapter2.scene_example import scene_of_row
from lifelore.experiments.chapter5.c5_02_functional_roles.measure import METHODS
from lifelore.figures.object_palette import method_palette
from lifelore.figures.scene_picture import draw_scene_on
from lifelore.figures.style import INK, LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    table = [row for row in result["rows"] if "role" in row]
    examples = [scene_of_row(row) for row in result["rows"] if "example" in row]
    overall = {name: result["measured"][f"map_{name}"] for name in METHODS}
    return draw_role_precision(table, overall, METHODS, examples)


_WIDTH, _GUTTER, _CAPTION, _CHART = 9.2, 0.1, 0.28, 3.3
"""Inches."""


def draw_role_precision(
    table: Sequence[Mapping],
    overall: Mapping[str, Mapping],
    methods: Mapping[str, str],
    scenes: Sequence[tuple[LabelledCloud, Mapping, str]] = (),
) -> "Figure":
    """A dot for each role and method, and the mean of all with its interval; pictures above.

    Parameters
    ----------
    table : sequence of mapping
        ``{"role", "queries", method: mean average precision, …}``.
    overall : mapping of method to measurement
        ``{"value", "ci95", "n"}``.
    methods : mapping of method to its name in words
    scenes : sequence of (cloud, document, caption)
        As of `scene_picture.draw_scene`.
    """
    wide = (_WIDTH - (len(scenes) + 1) * _GUTTER) / max(len(scenes), 1)
    height = _CHART + (0.75 * wide + _CAPTION + _GUTTER if scenes else 0.0)
    with house_style():
        figure = new_figure(_WIDTH, height)
        figure.set_layout_engine("none")
        for place, (cloud, document, caption) in enumerate(scenes):
            left, low = _GUTTER + place * (wide + _GUTTER), height - _CAPTION - 0.75 * wide
            axes = figure.add_axes((left / _WIDTH, low / height, wide / _WIDTH, 0.75 * wide / height))
            draw_scene_on(axes, cloud, document, (wide, 0.75 * wide), ("cloud", "networks"))
            axes.set_title(caption, fontsize=8.5, pad=4)
        axes = figure.add_axes((0.65 / _WIDTH, 0.6 / height, (_WIDTH - 0.75) / _WIDTH, (_CHART - 1.15) / height))
        _draw_dots(axes, table, overall, methods)
    return figure


def _draw_dots(
    axes: "Axes", table: Sequence[Mapping], overall: Mapping[str, Mapping], methods: Mapping[str, str]
) -> None:
    palette = method_palette(list(methods.values()))
    shifts = np.linspace(-0.3, 0.3, len(methods))
    for (method, name), shift in zip(methods.items(), shifts, strict=True):
        colour = palette[name]
        for place, row in enumerate(table, start=1):
            axes.plot([place + shift], [row[method]], "o", ms=4.5, color=colour, mew=0)
        measured = overall[method]
        axes.plot([shift], [measured["value"]], "s", ms=6.5, color=colour, mew=0, label=name)
        if measured["ci95"]:
            axes.plot([shift, shift], measured["ci95"], color=colour, lw=1.6)
    for place in range(len(table)):
        axes.axvline(place + 0.5, color=LIGHT if place else INK, lw=0.7)
    labels = [f"{row['role']}\n{row['queries']}" for row in table]
    axes.set_xticks(range(len(table) + 1), ["all", *labels], fontsize=7.5)
    axes.set(ylim=(0, 1.03), xlim=(-0.5, len(table) + 0.5), ylabel="mean average precision")
    axes.tick_params(axis="x", length=0)
    axes.grid(axis="y", color=LIGHT)
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=len(methods), handletextpad=0.2)
