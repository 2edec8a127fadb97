"""Policy reuse, UCB1 and GP-UCB: regret by episode (Figure 4.11)."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import GREY, Axes
from reproduction.chapter4.reuse.looks import draw_linear, look_of
from reproduction.chapter4.surveillance.peers import GIVEN
from reproduction.chapter4.surveillance.runs import DRAWN
from reproduction.figures.panels import panels


@panels(7.2, 4.2, grid="")
def draw(result: Mapping, axes: Axes) -> None:
    """Means of fifty tasks, a standard deviation shaded (not interval estimation's); what each was given."""
    for row in result["rows"][:3]:
        mean, deviation = np.array(row["mean"]), np.array(row["deviation"])
        band = np.maximum(mean - deviation, 0), mean + deviation
        axes.fill_between(range(1, len(mean) + 1), *band, color=look_of(row["method"])["color"], alpha=0.15, lw=0)
    draw_linear(axes, {row["method"]: row["mean"] for row in result["rows"]}, 1, xlabel="episode", ylabel="regret")
    axes.set_title(f"Surveillance, {DRAWN[1]} random tasks, learnt models")
    axes.figure.legend(*axes.get_legend_handles_labels(), loc="outside right upper")
    given = {"EI": "models of every type and policy"} | {
        row["method"]: GIVEN[row["method"]] for row in result["rows"][1:]
    }
    axes.figure.supxlabel(
        "\n".join(f"{name} is given {words}" for name, words in given.items()), fontsize=7.5, color=GREY
    )
