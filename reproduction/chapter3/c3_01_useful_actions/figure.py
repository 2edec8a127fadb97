"""Figure of claim C3.1: two mazes with their useful actions, and the useful shares of all mazes."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.lives.prior_arrows import draw_prior
from lifelore.figures.style import BLUE, GREY, SKY, VERMILION, Axes, Figure, new_figure
from reproduction.chapter3.c3_01_useful_actions.run import PRINTED, PRINTED_OF


def draw(result: Mapping) -> Figure:
    """The figure from the result: examples that its rows hold, then the spread of shares."""
    examples = [row for row in result["rows"] if "example" in row]
    figure = new_figure(9.2, 2.9)
    widths = [1.0] * len(examples) + [1.75]
    panels = figure.subplots(1, len(widths), squeeze=False, gridspec_kw={"width_ratios": widths})[0]
    for axes, row in zip(panels, examples, strict=False):
        draw_prior(axes, row["shape"], row["cells"], row["probs"], row["counted"], negligible=0.0)
        axes.set_anchor("N")
        axes.set_title(f"{row['example']} of {4 * len(row['cells'])} actions useful")
    _draw_shares(panels[-1], result)
    return figure


def _draw_shares(axes: Axes, result: Mapping) -> None:
    """Shares of mazes by useful share, bars for each generator; a line for each printed share."""
    from matplotlib.ticker import MaxNLocator

    generators = result["settings"]["generators"]
    for place, (generator, colour) in enumerate(zip(generators, (BLUE, SKY, GREY), strict=False)):
        rows = [row for row in result["rows"] if row.get("generator") == generator]
        share = np.array([row["useful"] / row["actions"] for row in rows])
        mazes = np.array([row["mazes"] for row in rows])
        width = 100 / rows[0]["actions"] / (len(generators) + 0.35)
        beside = 100 * share + width * (place - (len(generators) - 1) / 2)
        axes.bar(beside, 100 * mazes / mazes.sum(), width, color=colour, label=generator)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, steps=[1, 5, 10]))
    top = axes.get_ylim()[1] * 1.2
    for share in (100 * printed / PRINTED_OF for printed in PRINTED):
        axes.axvline(share, color=VERMILION, linewidth=1.3, zorder=0)
        axes.annotate(
            f"thesis: {share:.2f} %", (share, top), (4, -1), textcoords="offset points",
            va="top", fontsize=7.5, color=VERMILION,
        )  # fmt: skip
    axes.set(ylim=(0, top), xlabel="useful share of all actions (%)", ylabel="share of mazes (%)")
    axes.set_title(f"Over {result['settings']['mazes']:,} mazes of either kind")
    axes.legend(loc="upper right", bbox_to_anchor=(1.02, 0.93), title="obstacles", title_fontsize=8)
