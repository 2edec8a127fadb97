"""Looks of chapter 4's figures: colour and line of each rule, peer, signal and learner; curves of regret."""

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from lifelore.core.errors import NotFoundError
from lifelore.figures.curves import draw_curves
from lifelore.figures.style import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PURPLE, SKY, VERMILION, YELLOW

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SOLID: Any = "-"
PRINTED: Any = (0, (2, 1.2))
"""Forms as printed are dashed in the colour of their standard form."""
DOTS: Any = (0, (1, 1.2))
DASHES: Any = (0, (4, 2))

LOOKS: dict[str, tuple[str, Any]] = {
    "greedy": (GREY, SOLID),
    "eps-greedy": (YELLOW, SOLID),
    "sampling": (GREEN, SOLID),
    "PI": (PURPLE, SOLID),
    "PI, printed": (PURPLE, PRINTED),
    "EI": (BLUE, SOLID),
    "EI, printed": (BLUE, PRINTED),
    "BE": (ORANGE, SOLID),
    "BE, printed": (ORANGE, PRINTED),
    "BE, κ 30": (ORANGE, DOTS),
    "KG": (VERMILION, SOLID),
    "KG, printed": (VERMILION, PRINTED),
    "IDS": (SKY, SOLID),
    # peers, which know no types
    "UCB1": (VERMILION, SOLID),
    "UCB1, flat": (VERMILION, DOTS),
    "UCB1, tuned": (VERMILION, PRINTED),
    "GP-UCB": (ORANGE, SOLID),
    "GP-UCB, tuned": (ORANGE, PRINTED),
    "GP-UCB, true metric": (PURPLE, PRINTED),
    "GP-UCB, prior covariance": (PURPLE, DOTS),
    "interval estimation": (INK, PRINTED),
    "eps-greedy on means": (YELLOW, SOLID),
    "clustered UCB": (GREEN, PRINTED),
    "Thompson": (GREEN, DOTS),
    "EXP-3": (SKY, PRINTED),
    "try all": (GREY, SOLID),
    # signals
    "(s, a, s′)": (BLUE, SOLID),
    "(s, a, r)": (GREEN, SOLID),
    "U": (VERMILION, SOLID),
    "random": (INK, DOTS),
    # learners of the ball game
    "EXP-3 as printed": (VERMILION, SOLID),
    "EXP-3 tuned": (VERMILION, DASHES),
    "best static speed": (INK, SOLID),
    "BEAT, ε as printed": (BLUE, SOLID),
    "BEAT, ε = 1/n": (PURPLE, DASHES),
    "BEAT": (SKY, SOLID),
    "BEAT, told the population": (GREEN, DASHES),
    "best speed of each type": (GREY, DOTS),
}


def look_of(name: str) -> tuple[str, Any]:
    """Colour and line style of a rule, peer, signal or learner."""
    if name not in LOOKS:
        raise NotFoundError(
            f"no look for '{name}'; add it to chapter4/reuse_figures.py, beside {', '.join(LOOKS)}"
        )
    return LOOKS[name]


def lines_of(names: Iterable[str], **properties: Any) -> dict[str, dict[str, Any]]:
    """Line properties by name, as `draw_curves` takes them."""
    return {name: {"color": look_of(name)[0], "linestyle": look_of(name)[1], **properties} for name in names}


def size_lines(sizes: Sequence[int], **properties: Any) -> dict[str, dict[str, Any]]:
    """Line properties of the ball sizes, ``b = 2`` and so on, dark for small balls and bright for large ones."""
    from matplotlib import colormaps

    shades = colormaps["viridis"](np.linspace(0.0, 0.9, len(sizes)))
    return {f"b = {b}": {"color": shade, **properties} for b, shade in zip(sizes, shades, strict=True)}


def draw_regret(axes: "Axes", rows: Sequence[Mapping], title: str) -> None:
    """Draw each row's mean regret by episode, small and large values visible; solid lines have 95 % bands."""
    series = {}
    for row in rows:
        mean, half = np.array(row["curve"]["mean"]), 1.96 * np.array(row["curve"]["error"])
        series[row["method"]] = {"mean": mean}
        if look_of(row["method"])[1] == SOLID:
            series[row["method"]] |= {"low": np.maximum(mean - half, 0), "high": mean + half}
    draw_curves(
        axes, None, series, looks=lines_of(series, linewidth=1.5), title=title, xlabel="episode", legend=False
    )
    axes.set_yscale("symlog", linthresh=10, linscale=1)
    axes.set_yticks([0, 5, 10, 50, 100, 200], ["0", "5", "10", "50", "100", "200"])
    axes.minorticks_off()
    axes.set(ylim=(0, 330), xlim=(1, None))
    axes.grid(axis="y", color=LIGHT)
