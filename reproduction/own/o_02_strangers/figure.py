"""Share of tasks in which the detector has raised an alarm, by episode and kind of task."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREY, VERMILION, Axes
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels
from reproduction.own.o_02_strangers.run import CELLS, HELD, KNOWN

LOOKS = {KNOWN: {"color": GREY}, HELD: {"color": VERMILION}, CELLS: {"color": BLUE}}


@panels(5.8, 3.4)
def draw(result: Mapping, axes: Axes) -> None:
    """The dotted line is the false-alarm rate that was asked for."""
    asked = result["settings"]["false_alarm"]
    series = {row["kind"]: {"mean": row["alarms"]} for row in result["rows"]}
    draw_curves(axes, None, series, looks=LOOKS, level=(asked, f"false alarms asked for: {asked:.0%}"))
    axes.set(xlabel="episode", ylabel="tasks with an alarm so far (share)", ylim=(0, 1))
