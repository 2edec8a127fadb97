"""Figure of claim C3.16: the thesis's Figure 3.22, rewards of Q-learning with advice and without."""

from collections.abc import Mapping

from lifelore.figures.style import Axes
from reproduction.chapter3.advice.figures import ADVICE_COLOURS
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

LABELS = {"plain": "without advice", "advised": "with advice"}


@panels(6.4, 3.6)
def draw(result: Mapping, axes: Axes) -> None:
    """The figure from the result: tasks of the first mazes, with one standard deviation."""
    series = {LABELS[row["curve_of"]]: row for row in result["rows"]}
    looks = {label: {"color": ADVICE_COLOURS[label]} for label in series}
    draw_curves(axes, None, series, looks=looks, xlabel="episode", ylabel="reward of an episode")
    axes.set(ylim=(0, 1000), xlim=(0, result["settings"]["episodes"]))
