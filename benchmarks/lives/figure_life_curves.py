"""Share of the best possible return in first episodes over a life, for the agent and without each of its parts."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from lifelore.figures.style import BLUE, GREEN, GREY, ORANGE, SKY, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = {
    "full": BLUE,
    "full, raw clouds": SKY,
    "no-perception": ORANGE,
    "no-prior": GREEN,
    "no-reuse": VERMILION,
    "scratch": GREY,
}


def draw_life_curves(curves: Mapping[str, tuple[Any, Any]], new_from: int, n_lives: int) -> "Figure":
    """The figure: a curve for each agent.

    Parameters
    ----------
    curves : by agent, task numbers (n,) and shares (n,)
    new_from : first task on trays that the life has not met
    n_lives : number of lives behind each curve
    """
    with house_style():
        figure = new_figure(6.6, 4.0)
        axes = figure.subplots()
        axes.axhline(1, color=GREY, linewidth=0.8, linestyle=(0, (2, 2)))
        axes.axvline(new_from, color=GREY, linewidth=0.8, linestyle=(0, (2, 2)))
        for agent, (tasks, shares) in curves.items():
            axes.plot(tasks, shares, color=COLOURS[agent], linewidth=2 if agent == "full" else 1.3, label=agent)
        axes.annotate("new trays", (new_from + 1, 1.03), fontsize=8, color=GREY)
        low = min(float(min(shares)) for _, shares in curves.values())
        axes.set(
            xlabel="tasks lived",
            ylabel="first episode, share of the best possible",
            ylim=(max(-1.0, low - 0.05), 1.1),
            title=f"Tabletop jobs: ten tasks up to each, {n_lives} lives",
        )
        figure.legend(loc="outside lower center", ncols=len(curves), fontsize=8)
    return figure
