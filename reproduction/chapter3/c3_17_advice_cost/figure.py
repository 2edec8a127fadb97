"""Figure of claim C3.17: the thesis's Figure 3.23, advice in 100 steps by κ."""

from collections.abc import Mapping

from lifelore.figures.style import GREY, Axes
from reproduction.chapter3.advice.figures import AGENT_COLOURS, AGENTS
from reproduction.chapter3.advice.mazes import KAPPA
from reproduction.chapter3.c3_17_advice_cost.run import kappas_of
from reproduction.figures.panels import panels


@panels(6.4, 3.8)
def draw(result: Mapping, axes: Axes) -> None:
    """The figure from the result: walks of one maze, with one standard deviation."""
    kappas = kappas_of(result["settings"])
    for place, row in enumerate(result["rows"]):
        agent, shift = row["curve_of"], 0.004 * kappas[-1] * (place - 2)
        axes.errorbar(
            [kappa + shift for kappa in kappas], row["mean"], row["deviation"], color=AGENT_COLOURS[agent],
            label=AGENTS[agent], lw=1.5, elinewidth=0.8, marker="o", ms=3,
        )  # fmt: skip
    axes.axvline(KAPPA, color=GREY, lw=0.9, ls=(0, (4, 3)))
    axes.set(xlabel="κ (nats)", ylabel="advised steps in 100", ylim=(0, 104))
    axes.legend()
