"""Accuracy while a cloud gets worse: points discarded, noise added, labels wrong at the border (thesis §2.4.1)."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.core.errors import InputError
from lifelore.experiments.chapter2.c2_05_discarded_points.measure import (
    KINDS,
    LITERAL,
    METHODS,
    OURS,
    THESIS,
)
from lifelore.experiments.chapter2.spoilt_scenes import BORDER, DISCARDED, MASKS, NOISE, WHOLE
from lifelore.figures.object_palette import method_palette
from lifelore.figures.style import GREY, LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SHOWN = {OURS: "lifelore", THESIS: "thesis", LITERAL: "thesis, every word"}
PANELS = {
    DISCARDED: ("points discarded", "points discarded (%)", 100),
    NOISE: ("depth noise added", "standard deviation (mm)", 1000),
    BORDER: ("labels swapped", "of points within 5 mm (%)", 100),
    MASKS: ("masks grown", "over others by (mm)", 1000),
}
"""Of each way a title, the name of its axis and the factor from its levels to that axis."""


def panels_of(rows: Sequence[Mapping]) -> list[dict]:
    """Rows as `figures.robustness_curves` takes them: every way in simulation, points discarded in real scenes."""
    wanted = [(kind, way) for way in PANELS for kind in KINDS if kind == "simulated" or way == DISCARDED]
    panels = []
    for kind, way in wanted:
        of_kind = [row for row in rows if row["scenes"] == kind]
        if not any(row["way"] == way for row in of_kind):
            continue
        title, xlabel, factor = PANELS[way]
        curves = {}
        for method in METHODS:
            mine = [row for row in of_kind if row["method"] == method and row["way"] in (WHOLE, way)]
            if len(mine) > 1:
                ends = [row["exact"]["ci95"] or [row["exact"]["value"]] * 2 for row in mine]
                curves[SHOWN[method]] = {
                    "x": [factor * row["level"] for row in mine],
                    "mean": [row["exact"]["value"] for row in mine],
                    "low": [low for low, _ in ends],
                    "high": [high for _, high in ends],
                }
        pairs = of_kind[0]["pairs"]
        panel = {"title": f"{title}\n{kind}, {pairs:,} pairs", "xlabel": xlabel, "methods": curves}
        panels.append(panel | ({"mark": 70} if way == DISCARDED else {}))
    return panels


def draw(result: Mapping):
    return draw_robustness(panels_of(result["rows"]))


def draw_robustness(panels: Sequence[Mapping], *, ylabel: str = "pairs told exactly (%)") -> "Figure":
    """One panel a disturbance, one line a method, its 95 % interval shaded.

    Parameters
    ----------
    panels : sequence of mapping
        Each ``{"title", "xlabel", "methods": {name: {"x", "mean", "low", "high"}}}``, shares in [0, 1]; optional
        ``"mark"``: an x the thesis names.
    ylabel : str

    Raises
    ------
    InputError
        There is no panel, or a method's arrays differ in length.
    """
    if not panels:
        raise InputError("panels must name at least one disturbance, got none")
    names = list(dict.fromkeys(name for panel in panels for name in panel["methods"]))
    palette = method_palette(names)
    with house_style():
        figure = new_figure(min(3.1 * len(panels) + 1.9, 12), 3.1)
        every = figure.subplots(1, len(panels), squeeze=False, sharey=True)[0]
        for axes, panel in zip(every, panels, strict=True):
            _panel(axes, panel, palette)
        every[0].set_ylabel(ylabel)
        lines = {line.get_label(): line for axes in every for line in axes.lines if line.get_label() in palette}
        figure.legend([lines[name] for name in names], names, loc="outside right upper")
    return figure


def _panel(axes: "Axes", panel: Mapping, palette: Mapping[str, str]) -> None:
    for name, curve in panel["methods"].items():
        x, mean = np.asarray(curve["x"], float), 100 * np.asarray(curve["mean"], float)
        low, high = 100 * np.asarray(curve["low"], float), 100 * np.asarray(curve["high"], float)
        if not x.shape == mean.shape == low.shape == high.shape:
            shapes = [part.shape for part in (x, mean, low, high)]
            raise InputError(f"x, mean, low and high of '{name}' must agree in shape, got {shapes}")
        front = 4 if name == "lifelore" else 3
        axes.fill_between(x, low, high, color=palette[name], alpha=0.14, lw=0, zorder=2)
        axes.plot(x, mean, "o-", color=palette[name], label=name, ms=3.6, lw=1.7, zorder=front)
    if "mark" in panel:
        axes.axvline(panel["mark"], color=GREY, lw=1, ls=(0, (4, 3)), zorder=1)
        axes.annotate(
            "thesis", (panel["mark"], 1), (-3, -2), xycoords=("data", "axes fraction"), textcoords="offset points",
            ha="right", va="top", fontsize=7.5, color=GREY,
        )  # fmt: skip
    axes.grid(axis="y", color=LIGHT)
    axes.set(title=panel["title"], xlabel=panel["xlabel"])
