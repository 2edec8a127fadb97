"""What policy reuse knows: policies' performance over a line of tasks (after the thesis's Figure 4.1)."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PAPER, VERMILION, house_style, new_figure

_COLOURS = (BLUE, GREEN, ORANGE)


def draw_performance_curves(
    tasks: ArrayLike,
    curves: Mapping[str, ArrayLike],
    types: Mapping[str, float],
    new_task: float,
    *,
    shown: tuple[str, str],
    deviation: float,
    epsilon: float,
):
    """Curves, the points known of them, and the points a new task asks about.

    `tasks` ``(n,)`` are places in the space of tasks, `curves` policy → its performance ``(n,)`` there, `types`
    type → its place. The distribution of performance of the (type, policy) `shown` is drawn with its deviation;
    performances within the shown type differ by at most `epsilon`: the tasks of this ε-ball are shaded.
    """
    place, known = np.asarray(tasks, float), {name: np.asarray(c, float) for name, c in curves.items()}
    with house_style():
        figure = new_figure(7.6, 4.3)
        axes = figure.subplots()
        _shade_ball(axes, place, known, types[shown[0]], epsilon)
        for colour, (name, values) in zip(_COLOURS, known.items(), strict=False):
            axes.plot(place, values, color=colour, lw=2)
            axes.annotate(
                name, (place[-1], values[-1]), (6, 0), textcoords="offset points", color=colour, va="center",
                fontsize=11,
            )  # fmt: skip
            known_at = [*types.values()]
            axes.plot(known_at, np.interp(known_at, place, values), "o", color=INK, ms=5, zorder=5)
            asked = np.interp([new_task], place, values)
            axes.plot([new_task], asked, "o", ms=8, mfc=PAPER, mec=VERMILION, mew=1.8, zorder=6)
        axes.axvline(new_task, color=VERMILION, lw=1, ls=(0, (4, 3)))
        _draw_distribution(axes, types[shown[0]], place, known[shown[1]], deviation, shown)
        ticks = {**types, "$x^*$": new_task}
        axes.set_xticks(list(ticks.values()), list(ticks))
        axes.tick_params(axis="x", labelsize=11)
        axes.set(
            xlabel="tasks", ylabel="performance", yticks=[], xlim=(place[0], place[-1]),
            title="Known: the black points. Asked: which hollow one is highest",
        )  # fmt: skip
    return figure


def _shade_ball(axes, place: NDArray, known: Mapping[str, NDArray], at: float, epsilon: float) -> None:
    """The tasks around a type on which no policy's performance differs from the type's by more than ε / 2."""
    differences = [np.abs(values - np.interp(at, place, values)) for values in known.values()]
    inside = place[np.max(differences, axis=0) <= epsilon / 2]
    # Only what hangs together with the type itself.
    gap = 1.5 * np.diff(place).max()
    left, right = at, at
    for x in inside[inside >= at]:
        right = x if x - right <= gap else right
    for x in inside[inside <= at][::-1]:
        left = x if left - x <= gap else left
    axes.axvspan(left, right, color=GREY, alpha=0.16, lw=0)
    axes.annotate(
        "ε-ball", ((left + right) / 2, 0.98), xycoords=("data", "axes fraction"), ha="center", va="top",
        fontsize=8, color=GREY,
    )  # fmt: skip


def _draw_distribution(
    axes, at: float, place: NDArray, values: NDArray, deviation: float, shown: tuple[str, str]
) -> None:
    centre, width = float(np.interp(at, place, values)), 0.05 * (place[-1] - place[0])
    height = np.linspace(-3, 3, 80)
    bell = at - width * np.exp(-(height**2) / 2)
    axes.fill_betweenx(centre + deviation * height, at, bell, color=INK, alpha=0.25, lw=0, zorder=4)
    axes.plot(bell, centre + deviation * height, color=INK, lw=1, zorder=4)
    type_name, policy = (name.strip("$") for name in shown)
    axes.annotate(
        f"$P(U\\,|\\,{type_name},{policy})$", (at, centre - 2.2 * deviation), (6, -4), textcoords="offset points",
        ha="left", va="top", fontsize=9,
    )  # fmt: skip
