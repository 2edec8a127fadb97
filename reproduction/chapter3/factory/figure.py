"""Learning curves in the factory as the thesis draws them: rewards by episode, one standard deviation shaded."""

from collections.abc import Collection, Mapping, Sequence

import numpy as np

from lifelore.figures.style import GREY, Axes, Figure, new_figure
from reproduction.chapter3.learning.schedules import Epsilon
from reproduction.figures.curves import draw_curves

Looks = Mapping[str, tuple[str, str]]
"""Method → its label and colour, in the order of drawing."""


def draw_rewards(
    axes: Axes,
    result: Mapping,
    rows: Sequence[Mapping],
    looks: Looks,
    episodes: int,
    title: str = "",
    plain: Collection[str] = (),
) -> None:
    """Draw the rows with ``curve_of`` a method of `looks`, and the optimal reward; the axes are linear.

    Methods in `plain` have no shade.
    """
    curves = {row["curve_of"]: row for row in rows if row.get("curve_of") in looks}
    points = len(next(iter(curves.values()))["mean"])
    draw_curves(
        axes,
        (np.arange(points) + 0.5) * episodes / points + 0.5,
        {
            label: {"mean": curves[method]["mean"]} if method in plain else curves[method]
            for method, (label, _) in looks.items()
        },
        looks={label: {"color": colour, "linewidth": 1.5} for label, colour in looks.values()},
        title=title, xlabel="episode", ylabel="reward of an episode",
        level=(result["measured"]["optimal_reward"]["value"], "optimal"), legend=False,
    )  # fmt: skip
    lowest = min(min(row["mean"]) for row in curves.values())
    # Rewards are skewed: a standard deviation reaches far above what can be earned.
    axes.set(xlim=(0, episodes), ylim=(1.15 * lowest, -0.06 * lowest))
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}".replace("-", "−"))


def one_panel(result: Mapping, looks: Looks, plain: Collection[str] = ()) -> Figure:
    """A figure of one panel with the curves of the default."""
    figure = new_figure(6.4, 4.2)
    axes = figure.subplots()
    draw_rewards(axes, result, result["rows"], looks, result["settings"]["episodes"], plain=plain)
    axes.legend(loc="lower right")
    shaded = ", ".join(label.partition(":")[0] for name, (label, _) in looks.items() if name not in plain)
    figure.supxlabel(caption(result["settings"]) + (f" ({shaded})." if plain else "."), fontsize=8, color=GREY)
    return figure


def caption(settings: Mapping) -> str:
    """The count of runs, the default's schedule, and the meaning of the shades, without a full stop."""
    tasks = f" of {settings['test_tasks']} tasks" if settings.get("test_tasks", 1) > 1 else ""
    schedule = schedule_in_words(settings["schedule"][0])
    return f"{settings['runs']} runs{tasks}; {schedule}.\nShaded: one standard deviation across tasks"


def schedule_in_words(epsilon: Epsilon) -> str:
    """A schedule as captions name it."""
    if isinstance(epsilon, str):
        return "ε = α = 0.5, less 0.5/N an episode"
    first, decay, least = epsilon
    return f"ε = {first:g}" if decay == 1 else f"ε = {first:g}, × {decay:g} an episode to {least:g}"
