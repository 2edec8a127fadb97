"""Policy reuse, UCB1 and GP-UCB: regret by episode (Figure 4.11)."""

from collections.abc import Mapping

from lifelore.figures.style import GREY, Axes
from reproduction.chapter4.reuse.looks import look_of
from reproduction.chapter4.surveillance.peers import GIVEN
from reproduction.chapter4.surveillance.runs import DRAWN
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels


@panels(7.2, 4.2)
def draw(result: Mapping, axes: Axes) -> None:
    """Means of fifty tasks, a standard deviation shaded (not interval estimation's); what each was given."""
    series = {row["method"]: dict(row) for row in result["rows"]}
    series["interval estimation"].pop("deviation")
    looks = {name: look_of(name) for name in series}
    draw_curves(axes, None, series, looks=looks, xlabel="episode", ylabel="regret", legend=False)
    axes.set(ylim=(0, None), xlim=(0, None))
    axes.set_title(f"Surveillance, {DRAWN[1]} random tasks, learnt models")
    axes.figure.legend(*axes.get_legend_handles_labels(), loc="outside right upper")
    given = {"EI": "models of every type and policy"} | {
        row["method"]: GIVEN[row["method"]] for row in result["rows"][1:]
    }
    axes.figure.supxlabel(
        "\n".join(f"{name} is given {words}" for name, words in given.items()), fontsize=7.5, color=GREY
    )
