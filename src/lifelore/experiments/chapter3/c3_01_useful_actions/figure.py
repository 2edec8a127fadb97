"""Figure of claim C3.1: two mazes with their useful actions, and where such mazes lie among all."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter3.c3_01_useful_actions.run import PRINTED
from lifelore.figures.prior_arrows import draw_prior
from lifelore.figures.style import BLUE, GREY, SKY, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_useful_actions(result, [printed / 76 for printed in PRINTED])


_COLOURS = (BLUE, SKY, GREY)


def draw_useful_actions(result: Mapping, printed: Sequence[float]) -> "Figure":
    """The figure from the result of C3.1; `printed` are the thesis's shares.

    Parameters
    ----------
    result : mapping
        Its rows hold ``{"generator", "useful", "actions", "mazes"}`` and examples with a prior.
    printed : sequence of float
    """
    examples = [row for row in result["rows"] if "example" in row]
    with house_style():
        figure = new_figure(9.2, 2.9)
        widths = [1.0] * len(examples) + [1.75]
        panels = figure.subplots(1, len(widths), squeeze=False, gridspec_kw={"width_ratios": widths})[0]
        for axes, row in zip(panels, examples, strict=False):
            draw_prior(axes, row["shape"], row["cells"], row["probs"], row["counted"], negligible=0.0)
            axes.set_anchor("N")
            actions = 4 * len(row["cells"])
            axes.set_title(f"{row['example']} of {actions} actions useful")
        _draw_shares(panels[-1], result, printed)
    return figure


def _draw_shares(axes: "Axes", result: Mapping, printed: Sequence[float]) -> None:
    """How the useful share is spread over mazes, bars for each way of making them."""
    from matplotlib.ticker import MaxNLocator

    generators = result["settings"]["generators"]
    for place, (generator, colour) in enumerate(zip(generators, _COLOURS, strict=False)):
        rows = [row for row in result["rows"] if row.get("generator") == generator]
        share = np.array([row["useful"] / row["actions"] for row in rows])
        mazes = np.array([row["mazes"] for row in rows])
        width = 100 / rows[0]["actions"] / (len(generators) + 0.35)
        beside = 100 * share + width * (place - (len(generators) - 1) / 2)
        axes.bar(beside, 100 * mazes / mazes.sum(), width, color=colour, label=generator)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, steps=[1, 5, 10]))
    top = axes.get_ylim()[1] * 1.2
    for share in printed:
        axes.axvline(100 * share, color=VERMILION, linewidth=1.3, zorder=0)
        axes.annotate(
            f"thesis: {100 * share:.2f} %", (100 * share, top), (4, -1), textcoords="offset points",
            va="top", fontsize=7.5, color=VERMILION,
        )  # fmt: skip
    axes.set(ylim=(0, top), xlabel="useful share of all actions (%)", ylabel="share of mazes (%)")
    axes.set_title(f"Over {result['settings']['mazes']:,} mazes of either kind")
    axes.legend(loc="upper right", bbox_to_anchor=(1.02, 0.93), title="obstacles", title_fontsize=8)
