"""Figure of claim C3.4: learning with each prior, episodes to their end and cut off."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREEN, GREY, VERMILION, Figure, new_figure
from reproduction.chapter3.factory.figure import caption, draw_rewards

LOOKS = {
    "uniform": ("uniform prior", GREY),
    "learnt": ("learnt prior", BLUE),
    "expert": ("expert prior", GREEN),
    "incorrect": ("incorrect prior", VERMILION),
}


def draw(result: Mapping) -> Figure:
    """A panel for the default, and one for the first other cap of an episode's steps."""
    settings = result["settings"]
    caps = settings["max_steps"][:2]
    figure = new_figure(4.9 * len(caps), 4.0)
    for axes, cap in zip(figure.subplots(1, len(caps), squeeze=False)[0], caps, strict=True):
        rows = [row for row in result["rows"] if row["max_steps"] == cap]
        draw_rewards(axes, result, rows, LOOKS, settings["episodes"][0], f"episodes of at most {cap:,} steps")
        axes.legend(loc="lower right")
    figure.supxlabel(f"{caption(settings)}.", fontsize=8, color=GREY)
    return figure
