"""Figure of `bench deep`: goals found by exploring alone, and DQN's learning curves with a prior and without."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lifelore.figures.learning_curve import draw_curve
from lifelore.figures.style import GREY, INK, LIGHT, colour_of, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw_deep_curves(exploring: Mapping, learning: Mapping, names: Mapping[str, str]) -> "Figure":
    """The figure from the benchmark's ``exploring`` and ``learning``.

    Parameters
    ----------
    exploring : mapping
        World to who explores to ``{"value", "ci95"}``, the share of episodes that reach the goal.
    learning : mapping
        World to ``{"curves": {learner: {"steps", "mean", "ci95"}}}``.
    names : mapping
        Learner or explorer to a key of `style.COLOURS`; who has none is drawn light.
    """
    with house_style():
        figure = new_figure(11.4, 3.9)
        panels = figure.subplots(1, 1 + len(learning), width_ratios=[1.15, *[1.0] * len(learning)])
        _draw_bars(panels[0], exploring, names)
        for axes, (world, told) in zip(panels[1:], learning.items(), strict=True):
            for who, curve in told["curves"].items():
                draw_curve(
                    axes, curve["steps"], curve["mean"], tuple(np.transpose(curve["ci95"])), names[who], who
                )
            axes.set(title=f"Learning one {world}", xlabel="steps", ylim=(-0.02, 1.02))
            axes.locator_params(axis="x", nbins=4)
        panels[1].set_ylabel("greedy walk, 1 is the shortest way")
        panels[1].legend(loc="lower right")
        runs = len(next(iter(next(iter(learning.values()))["goals"].values())))
        figure.supxlabel(
            f"Bands and black lines: 95 % intervals. Curves: means over {runs} layouts, each learnt by a network "
            "of its own; the prior comes from other layouts.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _draw_bars(axes: "Axes", exploring: Mapping, names: Mapping[str, str]) -> None:
    who_explores = list(next(iter(exploring.values())))
    height = 0.8 / len(who_explores)
    for number, who in enumerate(who_explores):
        places = -np.arange(len(exploring)) - (number - (len(who_explores) - 1) / 2) * height
        shares = [told[who]["value"] for told in exploring.values()]
        colour = colour_of(names[who]) if who in names else LIGHT
        axes.barh(places, shares, height=0.92 * height, color=colour, label=who)
        for place, told in zip(places, exploring.values(), strict=True):
            if told[who]["ci95"]:
                axes.plot(told[who]["ci95"], [place, place], color=INK, linewidth=1.1, solid_capstyle="butt")
    axes.set(
        title="Exploring alone", xlabel="episodes that reach the goal", xlim=(0, 1),
        yticks=-np.arange(len(exploring)), yticklabels=[name.replace("Simple", "Simple\n") for name in exploring],
    )  # fmt: skip
    axes.legend(loc="lower right", fontsize=7)
