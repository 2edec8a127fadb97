"""Learning curves by schedule of ε: rewards by episode; returns by block of episodes with those to 80 %."""

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any, NamedTuple

from lifelore.figures.curves import draw_curves
from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.style import GREY, Axes, SubFigure
from reproduction.chapter3.learning.schedules import schedule_in_words
from reproduction.engine.curve_blocks import block_centres

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
    figure: SubFigure,
    result: Mapping,
    colours: Mapping[str, str],
    labels: Mapping[str, str],
    *,
    banded: Collection[str],
    dashed: Collection[str] = (),
) -> None:
    """A panel for each schedule, from rows that have ``curve_of``, ``schedule``, ``mean`` and ``deviation``.

    `result` has ``episodes`` and ``schedules`` among its settings and ``optimal_reward`` among its measures.
    `colours` are by method, in the order of drawing; methods without a label go by their name. The deviation of
    `banded` methods is shaded, the line of `dashed` ones is dashed.
    """
    schedules = result["settings"]["schedules"]
    panels = figure.subplots(1, len(schedules), squeeze=False, sharey=True)[0]
    for axes, schedule in zip(panels, schedules, strict=True):
        _draw_rewards(axes, result, schedule, colours, labels, banded, dashed)
    panels[0].set_ylabel("reward of an episode")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=8)


def _draw_rewards(
    axes: Axes,
    result: Mapping,
    schedule: Sequence[float],
    colours: Mapping[str, str],
    labels: Mapping[str, str],
    banded: Collection[str],
    dashed: Collection[str],
) -> None:
    rows = {row["curve_of"]: row for row in result["rows"] if "curve_of" in row and row["schedule"] == schedule}
    series, looks = {}, {}
    for method, colour in colours.items():
        label, parts = labels.get(method, method), ("mean", "deviation") if method in banded else ("mean",)
        series[label] = {part: rows[method][part] for part in parts}
        looks[label] = {"color": colour, "linewidth": 1.5, "linestyle": DASHES if method in dashed else "-"}
    draw_curves(
        axes, None, series, looks=looks, title=schedule_in_words(schedule), xlabel="episode", logarithmic="x",
        level=(result["measured"]["optimal_reward"]["value"], "optimal"), legend=False,
    )  # fmt: skip
    axes.set_xlim(1, result["settings"]["episodes"])
    axes.xaxis.set_major_formatter("{x:g}")


def draw_return_curves(
    figure: SubFigure,
    result: Mapping,
    methods_of: Callable[[Sequence[float]], Sequence[MethodCurve]],
    *,
    bars: float,
    ncols: int,
) -> None:
    """For each schedule curves of returns, and below them the episodes to 80 % of the optimum.

    `result` has ``episodes`` and ``schedules`` among its settings, ``optimal_return`` among its measures and
    ``curve_edges`` in a row. `methods_of` gives what is drawn for a schedule; `bars` is the height of the lower
    panel, that of the curves being 1; the legend has `ncols` columns.
    """
    schedules = result["settings"]["schedules"]
    panels = figure.subplots(2, len(schedules), squeeze=False, height_ratios=[1, bars], sharey="row")
    for (above, below), schedule in zip(panels.T, schedules, strict=True):
        _draw_returns(above, below, result, schedule, methods_of(schedule))
    panels[0, 0].set_ylabel("return of an episode")
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside upper left", ncols=ncols)


def _draw_returns(
    above: Axes, below: Axes, result: Mapping, schedule: Sequence[float], methods: Sequence[MethodCurve]
) -> None:
    looks = {
        m.label: {"color": m.colour, "linewidth": 1.0, "linestyle": DASHES}
        if m.is_aside
        else {"color": m.colour, "linewidth": 1.5}
        for m in methods
    }
    draw_curves(
        above, block_centres(curve_edges(result)),
        {m.label: {"mean": m.curve["mean"]} if m.is_aside else m.curve for m in methods}, looks=looks,
        title=schedule_in_words(schedule), xlabel="episode", logarithmic="x",
        level=(result["measured"]["optimal_return"]["value"], "optimal"), legend=False,
    )  # fmt: skip
    above.axhline(0, color=GREY, linewidth=0.6, zorder=0)
    above.xaxis.set_major_formatter("{x:g}")
    cap = result["settings"]["episodes"]
    draw_interval_bars(
        below, [""] * len(methods), {"": [m.to_80 for m in methods]},
        colours=[m.colour + ("59" if m.is_aside else "e6") for m in methods],
        words=lambda value: f"{'≥ ' if value >= cap else ''}{value:.0f}", label="episodes to 80 % of optimal",
    )  # fmt: skip
    below.set_xlim(0, 1.12 * cap)
