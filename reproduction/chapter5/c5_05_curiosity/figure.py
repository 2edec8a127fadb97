"""Points missed on new orders after spare time, by how its contexts are chosen."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.curves import draw_curves
from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    LIGHT,
    ORANGE,
    Axes,
    Figure,
    house_style,
    new_figure,
)
from reproduction.chapter5.c5_05_curiosity.run import CURIOUS, LEARNABLE, UNIFORM

LABELS = {
    UNIFORM: "uniform replay",
    CURIOUS: "entropy × frequency",
    LEARNABLE: "its removable part × frequency",
}
ASKED = {
    "Spare orders needed for the same competence": (
        {
            "curious_over_uniform_episodes": ("entropy ×\nfrequency", BLUE, 0.7, -1),
            "learnable_over_uniform_episodes": ("its removable\npart × frequency", ORANGE, 0.7, -1),
        },
        "as a ratio to uniform replay",
    ),
    "A type that arrives late": (
        {
            "late_type_auc": ("noticed: AUC\nof the alarm", GREEN, 0.9, 1),
            "late_type_learnt": ("added: share\nof lives", GREEN, 0.8, 1),
        },
        "AUC, and share",
    ),
}
"""By title of a panel: for each measure its words, its colour, the bound and the side asked for; and a label."""
LOOKS = {UNIFORM: {"color": GREY}, CURIOUS: {"color": BLUE, "linewidth": 2.2}, LEARNABLE: {"color": ORANGE}}


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    settings = result["settings"]
    figure = new_figure(10.4, 4.4)
    places = figure.add_gridspec(2, 2, width_ratios=[1.25, 1])
    axes, *beside = (figure.add_subplot(places[at]) for at in ((slice(None), 0), (0, 1), (1, 1)))
    series = {
        LABELS[row["chooser"]]: {"mean": row["mean"], "error": 1.96 * np.array(row["error"])}
        for row in result["rows"]
    }
    spans = settings["every"] * np.arange(len(result["rows"][0]["mean"]))
    looks = {LABELS[chooser]: look for chooser, look in LOOKS.items()}
    draw_curves(
        axes, spans, series, looks=looks, title="Competence, by how the context of spare orders is chosen",
        xlabel="spare orders", legend=False,
    )  # fmt: skip
    axes.set_ylabel("points below the best possible return")
    axes.grid(axis="y", color=LIGHT)
    axes.set_ylim(bottom=0)
    axes.legend(loc="lower left")
    for panel, (title, (names, label)) in zip(beside, ASKED.items(), strict=True):
        _draw_asked(panel, result["measured"], names)
        panel.set(title=title, xlabel=label)
    figure.supxlabel(
        f"Bands and lines: 95 % intervals of the mean over {settings['lives']} lives; of a late type, over "
        f"{settings['late_lives']} lives. Dashed: the bound that the verdict asks for, on the side of the arrow.\n"
        "The removable part is our own variant; it takes no part in the verdict.",
        fontsize=8, color=GREY,
    )  # fmt: skip
    return figure


def _draw_asked(axes: Axes, measured: Mapping, names: Mapping[str, tuple[str, str, float, int]]) -> None:
    """A bar for each measure with its interval, and the bound beside it."""
    colours = [colour for _, colour, *_ in names.values()]
    draw_interval_bars(
        axes, [words for words, *_ in names.values()], {"": [measured.get(name) for name in names]},
        colours=colours, words="{:.2f}".format, legend=False,
    )  # fmt: skip
    most = max([axes.get_xlim()[1], *(bound for *_, bound, _ in names.values())])
    axes.set_xlim(0, 1.15 * most)
    for place, (*_, bound, side) in enumerate(names.values()):
        axes.plot([bound, bound], [place - 0.48, place + 0.48], color=INK, linewidth=1.2, linestyle=(0, (3, 1.5)))
        axes.annotate(
            "", (bound + 0.07 * side * most, place - 0.45), (bound, place - 0.45), zorder=4,
            arrowprops={"arrowstyle": "->", "color": INK, "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0},
        )  # fmt: skip
