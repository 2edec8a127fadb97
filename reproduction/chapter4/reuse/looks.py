"""Looks of chapter 4's figures: colour and line of each rule, peer, signal and learner; curves of regret."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from lifelore.core.errors import NotFoundError
from lifelore.domains.ball_game.ball_game import SIZES
from lifelore.figures.curves import draw_curves
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PURPLE, SKY, VERMILION, YELLOW, Axes

SOLID, PRINTED, DOTS, DASHES = "-", (0, (2, 1.2)), (0, (1, 1.2)), (0, (4, 2))
"""Forms as printed are dashed in the colour of their standard form."""
_COLOURS: dict[Any, dict[str, str]] = {
    SOLID: {
        "greedy": GREY, "eps-greedy": YELLOW, "sampling": GREEN, "PI": PURPLE, "EI": BLUE, "BE": ORANGE,
        "KG": VERMILION, "IDS": SKY,
        "UCB1": VERMILION, "GP-UCB": ORANGE, "eps-greedy on means": YELLOW, "try all": GREY,
        "(s, a, s′)": BLUE, "(s, a, r)": GREEN, "U": VERMILION,
        "EXP-3 as printed": VERMILION, "best static speed": INK, "BEAT, ε as printed": BLUE, "BEAT": SKY,
    },
    PRINTED: {
        "PI, printed": PURPLE, "EI, printed": BLUE, "BE, printed": ORANGE, "KG, printed": VERMILION,
        "UCB1, tuned": VERMILION, "GP-UCB, tuned": ORANGE, "GP-UCB, true metric": PURPLE,
        "interval estimation": INK, "clustered UCB": GREEN, "EXP-3": SKY,
    },
    DOTS: {
        "BE, κ 30": ORANGE, "UCB1, flat": VERMILION, "GP-UCB, prior covariance": PURPLE, "Thompson": GREEN,
        "random": INK, "best speed of each type": GREY,
    },
    DASHES: {"EXP-3 tuned": VERMILION, "BEAT, ε = 1/n": PURPLE, "BEAT, told the population": GREEN},
}  # fmt: skip
"""By line style: rules, then peers, which know no types, then signals, then learners of the ball game."""
LOOKS = {name: (colour, style) for style, named in _COLOURS.items() for name, colour in named.items()}
"""Colour and line style by name."""

_SIZE_LOOKS = (
    (PURPLE, SOLID), (BLUE, DASHES), (SKY, (0, (3, 1, 1, 1))),
    (GREEN, SOLID), (ORANGE, DASHES), (VERMILION, SOLID),
)  # fmt: skip
"""Colour and line style of each of `SIZES`."""
GAMES_IN_WORDS = (
    "Games: layout and ball's radius r. “careless”: the player does not keep away from obstacles; “stays”: a "
    "blocked ball stays\ninstead of sliding along; “by maxima”: time and collisions are divided by the largest "
    "seen, instead of by fixed numbers."
)
"""What the names of the games mean."""


def look_of(name: str) -> tuple[str, Any]:
    """Colour and line style of a rule, peer, signal or learner."""
    if name not in LOOKS:
        raise NotFoundError(f"no look for '{name}'; add it to chapter4/reuse/looks.py, beside {', '.join(LOOKS)}")
    return LOOKS[name]


def lines_of(names: Iterable[str], **properties: Any) -> dict[str, dict[str, Any]]:
    """Line properties by name, as `draw_curves` takes them."""
    return {name: {"color": look_of(name)[0], "linestyle": look_of(name)[1], **properties} for name in names}


def size_lines(sizes: Sequence[int], **properties: Any) -> dict[str, dict[str, Any]]:
    """Line properties of the ball sizes, ``b = 2`` and so on, cold for small balls and warm for large ones."""
    looks = (_SIZE_LOOKS[SIZES.index(b)] for b in sizes)
    return {
        f"b = {b}": {"color": colour, "linestyle": style, **properties}
        for b, (colour, style) in zip(sizes, looks, strict=True)
    }


def draw_regret(axes: Axes, rows: Sequence[Mapping], title: str) -> None:
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


def draw_ratio_grid(axes: Axes, ratios: np.ndarray, rows: Sequence[str], columns: Sequence[str]) -> None:
    """A grid of ratios of losses, blue below 1."""
    certain, look = np.zeros(ratios.shape, bool), {"neutral": 1.0, "spread": 1.35, "good": "low", "ratio": True}
    draw_heat_grid(axes, ratios, certain, rows, columns, words="{:.2f}".format, **look)


def legend_below(axes: Axes, room: float, **options: Any) -> None:
    """A legend below the curves, in `room` added to the panel as a share of its height; a grid of heights."""
    low, high = axes.get_ylim()
    axes.set_ylim(low - room * (high - low), high)
    axes.grid(axis="y", color=LIGHT)
    axes.legend(loc="lower left", **options)
