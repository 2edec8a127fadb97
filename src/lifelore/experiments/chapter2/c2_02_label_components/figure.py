"""How often each component of a label is right and agreed on, beside its majority and the printed share."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from lifelore.figures.style import BLUE, GREY, INK, LIGHT, SKY, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PRINTED = {"on": (40, 28), "adjacent": (39, 18)}
"""Of 49: right, and in agreement with 75 % of the neighbours."""


def draw(result: Mapping):
    return draw_components(result["measured"], {name: [n / 49 for n in two] for name, two in PRINTED.items()})


_KEYS = {"right": BLUE, "majority": GREY, "agreement": SKY}
_WORDS = {"right": "right", "majority": "more frequent value", "agreement": "agrees with 75 % of neighbours"}


def draw_components(measured: Mapping[str, Mapping], printed: Mapping[str, Sequence[float]]) -> "Figure":
    """The figure: a panel a component; `printed` its shares right and agreed on, in [0, 1], marked by a line."""
    with house_style():
        figure = new_figure(8.2, 2.4)
        every = figure.subplots(1, len(printed), squeeze=False, sharey=True)[0]
        for axes, (name, (right, agreed)) in zip(every, printed.items(), strict=True):
            for place, (key, colour) in enumerate(_KEYS.items()):
                _bar(axes, place, measured[f"{name}_{key}"], colour)
            for place, share in ((0, right), (2, agreed)):
                axes.plot([100 * share] * 2, [place - 0.45, place + 0.45], color=VERMILION, lw=2.2, zorder=5)
            axes.set(xlim=(0, 108), xlabel="relationships told (%)", title=f"component {name}")
            axes.grid(axis="x", color=LIGHT)
            axes.spines["left"].set_visible(False)
            axes.tick_params(axis="y", length=0)
        every[0].set_yticks(range(len(_KEYS)), [_WORDS[key] for key in _KEYS])
        every[0].set_ylim(len(_KEYS) - 0.4, -0.6)
        every[-1].plot([], [], color=VERMILION, lw=2.2, label="thesis, of 49")
        every[-1].legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.2)
    return figure


def _bar(axes: "Axes", place: int, number: Mapping, colour: str) -> None:
    axes.barh([place], [100 * number["value"]], height=0.66, color=colour, zorder=2)
    if number["ci95"]:
        axes.plot([100 * end for end in number["ci95"]], [place] * 2, color=INK, lw=1.3, zorder=4)
    axes.annotate(
        f"{100 * number['value']:.1f}",
        (1.5, place),
        color="white",
        va="center",
        fontsize=8,
        fontweight="bold",
        zorder=6,
    )
