"""Errors of registrations by the angle between the cameras."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREY, SKY, VERMILION, Axes
from reproduction.figures.panels import panels
from reproduction.own.o_08_views_without_poses.run import WRONG_SHIFT, WRONG_TURN


@panels(6.0, 3.4, grid="both")
def draw(result: Mapping, axes: Axes) -> None:
    """The figure from the result: a point a registration; dashed: what counts as wrong."""
    for row, colour, marker in zip(result["rows"], (SKY, BLUE, VERMILION), "o^s", strict=False):
        turns, shifts = zip(*row["errors"], strict=True) if row["errors"] else ((), ())
        label = f"{row['angle']}° apart, {row['refused']} refused"
        axes.plot([1000 * shift for shift in shifts], turns, marker, ms=4.5, color=colour, mew=0, label=label)
    axes.axvline(1000 * WRONG_SHIFT, color=GREY, ls=(0, (3, 2)))
    axes.axhline(WRONG_TURN, color=GREY, ls=(0, (3, 2)))
    axes.set(xlabel="error at the objects (mm)", ylabel="error of the turn (degrees)")
    axes.set(title="Registrations of two views", xlim=(0, None), ylim=(0, None))
    axes.legend(loc="center right", bbox_to_anchor=(0.93, 0.5))
