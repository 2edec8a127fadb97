"""C4.7: policy reuse, bandits and Bayesian optimisation on the same tasks. Thesis: §4.6.4, Figure 4.11.

The settings of tuned peers are those of least regret on these very tasks; nothing of policy reuse is tuned.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

from lifelore.core.metrics import Estimate
from lifelore.figures.style import GREY, Axes
from reproduction.chapter4.reuse.looks import look_of
from reproduction.chapter4.reuse.many_tasks import grouped_mean
from reproduction.chapter4.surveillance.peers import GIVEN, PEERS
from reproduction.chapter4.surveillance.runs import (
    DEFAULT,
    DRAWN,
    READ,
    by_group,
    by_method,
    each_place,
    reserve_cells,
)
from reproduction.chapter4.surveillance.runs import run_method as run_cell
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

__all__ = ["cells", "measure", "readings", "rows", "run_cell", "shared"]
shared = READ
SHOWN = ("EI", "UCB1", "GP-UCB", "interval estimation")


def cells(settings: Mapping) -> list[dict]:
    """BPR-EI and its peers: learnt models in the default reserve, exact ones in every reserve."""
    return reserve_cells(settings, ("EI", *PEERS))


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Learnt models and untuned peers; sums of regret beside differences."""
    found = by_method(results, DEFAULT)
    sums = {f"sum_{name.replace('-', '_')}": grouped_mean(by_group(found[name], "sums")) for name in SHOWN[:3]}
    return sums | more_regret(found)


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """Each reserve with UCB1 and GP-UCB as published and tuned."""
    for place, found in each_place(settings, results):
        for ucb, gp in product(("UCB1", "UCB1, tuned"), ("GP-UCB", "GP-UCB, tuned")):
            yield {"UCB1": ucb, "GP-UCB": gp, **place}, more_regret(found, ucb, gp)


def more_regret(found: Mapping[str, Mapping], ucb: str = "UCB1", gp: str = "GP-UCB") -> dict[str, Estimate]:
    """How much more summed regret peers have than reuse, and UCB1 than GP-UCB, paired by task."""
    names = {"EI": "EI", "UCB1": ucb, "GP_UCB": gp, "interval_estimation": "interval estimation"}
    sums = {key: by_group(found[name], "sums") for key, name in names.items()}
    pairs = [(peer, "EI") for peer in sums if peer != "EI"] + [("UCB1", "GP_UCB")]
    return {f"{worse}_minus_{better}": grouped_mean(sums[worse] - sums[better]) for worse, better in pairs}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean and deviation of regret by episode over fifty tasks with learnt models."""
    found = by_method(results, DEFAULT)
    return [{"method": name, **found[name]["curves"][1]} for name in SHOWN]


@panels(7.2, 4.2)
def draw(result: Mapping, axes: Axes) -> None:
    """Policy reuse, UCB1 and GP-UCB: regret by episode (Figure 4.11).

    Means of fifty tasks, a standard deviation shaded (not interval estimation's); what each was given.
    """
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
