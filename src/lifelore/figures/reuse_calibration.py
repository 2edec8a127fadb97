"""Picture of calibration: shares observed over predicted probabilities of types and quantiles of outcomes."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from lifelore.core.errors import InputError
from lifelore.figures.style import BLUE, GREY, LIGHT, ORANGE, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PANELS = {
    "outcomes": (
        "Quantiles of outcomes",
        "level of the predicted quantile",
        "share of outcomes at or below it",
        BLUE,
    ),
    "types": ("Probabilities of types", "predicted probability of a type", "share of users of that type", ORANGE),
}


def draw_calibration(document: Mapping[str, Any]) -> "Figure":
    """A panel for each calibration that there is; points on the dashed line are right.

    Parameters
    ----------
    document : mapping
        ``outcomes`` and ``types``, each None, left out, or plain data with ``predicted``, ``observed``, ``ci95``,
        ``n``, ``groups`` and ``error``.

    Raises
    ------
    InputError
        There is neither.
    """
    shown = [name for name in PANELS if document.get(name)]
    if not shown:
        raise InputError("document must have a calibration of outcomes or of types, it has neither")
    with house_style():
        figure = new_figure(4.2 * len(shown), 4.5)
        for axes, name in zip(figure.subplots(1, len(shown), squeeze=False)[0], shown, strict=True):
            _draw_panel(axes, document[name], *PANELS[name])
        figure.supxlabel("dashed: calibrated; bars: 95 % intervals by the spread of users", fontsize=8, color=GREY)
    return figure


def _draw_panel(axes: "Axes", found: Mapping[str, Any], title: str, xlabel: str, ylabel: str, colour: str) -> None:
    axes.plot([0, 1], [0, 1], color=GREY, linestyle=(0, (4, 3)), linewidth=1.1, zorder=1)
    axes.plot(found["predicted"], found["observed"], color=colour, linewidth=1.2, alpha=0.6, zorder=2)
    most = max(found["n"])
    for place, share, interval, n in zip(
        found["predicted"], found["observed"], found["ci95"], found["n"], strict=True
    ):
        if interval:
            axes.plot([place, place], interval, color=colour, linewidth=1.4, zorder=3)
        axes.plot([place], [share], "o", color=colour, ms=3 + 4 * (n / most) ** 0.5, zorder=4)
    axes.set(title=title, xlabel=xlabel, ylabel=ylabel, xlim=(-0.02, 1.02), ylim=(-0.02, 1.02))
    axes.set_aspect("equal")
    axes.grid(color=LIGHT)
    total = found["n"][0] if title.startswith("Quantiles") else sum(found["n"])
    axes.text(
        0.03, 0.97, f"{total:,} predictions for {found['groups']:,} users\nmean distance {found['error']:.3f}",
        transform=axes.transAxes, va="top", fontsize=8, color=GREY,
    )  # fmt: skip
