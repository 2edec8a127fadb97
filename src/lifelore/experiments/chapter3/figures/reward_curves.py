"""Learning curves in figures of chapter 3: rewards by episode; returns by block with the episodes to 80 %."""

from collections.abc import Collection, Mapping, Sequence
from typing import Any, NamedTuple

from lifelore.experiments.chapter3.learning.schedules import schedule_in_words
from lifelore.experiments.engine.curve_blocks import block_centres
from lifelore.figures.curves import draw_curves
from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.style import GREY, Axes

DASHES = (0, (4, 2))


class MethodCurve(NamedTuple):
    """A method's curve of returns and its episodes to 80 % of the optimum, ``{"value", "ci95"}``."""

    label: str
    colour: str
    curve: Mapping[str, Sequence[float]]
    to_80: Mapping[str, Any]
    is_aside: bool = False
    """Drawn dashed and without a band."""


def curve_edges(result: Mapping) -> list[int]:
    """Edges of the blocks of episodes of a result's curves."""
    return next(row["curve_edges"] for row in result["rows"] if "curve_edges" in row)


def draw_reward_curves(
    axes: Axes,
    result: Mapping,
    schedule: Sequence[float],
    colours: Mapping[str, str],
    labels: Mapping[str, str],
    *,
    banded: Collection[str],
    dashed: Collection[str] = (),
) -> None:
    """One panel from the rows of a result that have ``curve_of``, ``schedule``, ``mean`` and ``deviation``.

    Parameters
    ----------
    axes : Axes
    result : mapping
        With ``episodes`` among its settings and ``optimal_reward`` among its measures.
    schedule : sequence of float
        The curves' own, and the panel's title.
    colours : mapping of str to str
        By method, in the order of drawing.
    labels : mapping of str to str
        Methods left out go by their name.
    banded, dashed : collection of str
        Methods whose deviation is shaded; methods whose line is dashed.
    """
    rows = {row["curve_of"]: row for row in result["rows"] if "curve_of" in row and row["schedule"] == schedule}
    parts = {method: ("mean", "deviation") if method in banded else ("mean",) for method in colours}
    draw_curves(
        axes,
        None,
        {labels.get(m, m): {part: rows[m][part] for part in parts[m]} for m in colours},
        looks={
            labels.get(m, m): {"color": c, "linewidth": 1.5, "linestyle": DASHES if m in dashed else "-"}
            for m, c in colours.items()
        },
        title=schedule_in_words(schedule),
        xlabel="episode",
        logarithmic="x",
        level=(result["measured"]["optimal_reward"]["value"], "optimal"),
        legend=False,
    )
    axes.set_xlim(1, result["settings"]["episodes"])
    axes.xaxis.set_major_formatter("{x:g}")


def draw_return_curves(
    panels: Sequence[Axes], result: Mapping, schedule: Sequence[float], methods: Sequence[MethodCurve]
) -> None:
    """Curves of returns under a schedule in the first panel, episodes to 80 % of the optimum in the second.

    Parameters
    ----------
    panels : two axes
    result : mapping
        With ``episodes`` among its settings, ``optimal_return`` among its measures and ``curve_edges`` in a row.
    schedule : sequence of float
        The curves' own, and the title.
    methods : sequence of MethodCurve
    """
    above, below = panels
    draw_curves(
        above,
        block_centres(curve_edges(result)),
        {m.label: {"mean": m.curve["mean"]} if m.is_aside else m.curve for m in methods},
        looks={
            m.label: {
                "color": m.colour,
                "linewidth": 1.0 if m.is_aside else 1.5,
                "linestyle": DASHES if m.is_aside else "-",
            }
            for m in methods
        },
        title=schedule_in_words(schedule),
        xlabel="episode",
        logarithmic="x",
        level=(result["measured"]["optimal_return"]["value"], "optimal"),
        legend=False,
    )
    above.axhline(0, color=GREY, linewidth=0.6, zorder=0)
    above.xaxis.set_major_formatter("{x:g}")
    cap = result["settings"]["episodes"]
    draw_interval_bars(
        below,
        [""] * len(methods),
        {"": [m.to_80 for m in methods]},
        colours=[m.colour + ("59" if m.is_aside else "e6") for m in methods],
        words=lambda value: f"{'≥ ' if value >= cap else ''}{value:.0f}",
        label="episodes to 80 % of optimal",
    )
    below.set_xlim(0, 1.12 * cap)
