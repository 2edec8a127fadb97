"""C4.6: how much regret varies over ten surveillance tasks, by rule and episode. Thesis: §4.6.4, Table 4.3."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.figures.style import INK, Axes
from reproduction.chapter4.reuse.looks import look_of
from reproduction.chapter4.reuse.rules import FORMS, PI_PRINTED, RULES, STANDARD, in_form
from reproduction.chapter4.surveillance.runs import AFTER, DEFAULT, READ, by_method, each_place, reserve_cells
from reproduction.chapter4.surveillance.runs import run_method as run_cell
from reproduction.engine.estimates import share_of
from reproduction.figures.panels import panels

__all__ = ["cells", "measure", "readings", "rows", "run_cell", "shared"]
shared = READ
PRINTED = {
    "ε-greedy": (72.193, 97.999, 83.21, 86.172),
    "sampling": (103.07, 86.469, 18.834, 10.897),
    "KG": (76.577, 75.268, 7.1152, 18.489),
    "BE": (96.529, 91.288, 17.74, 13.813),
    "PI": (15.695, 62.4, 72.173, 101.69),
    "EI": (27.801, 33.112, 16.011, 11.142),
}
"""After 5, 10, 20 and 50 episodes."""
CONVERGE = ("sampling", "KG", "BE", "EI")
REGRETS = ("size of realised", "realised", "against mean", "expected")
"""Regret of one pay against another in size or with its sign, of one pay against the best mean, and expected."""


def cells(settings: Mapping) -> list[dict]:
    """Every rule in both forms: learnt models in the default reserve, exact ones in every reserve."""
    return reserve_cells(settings, RULES)


def deviations(result: Mapping, regret: str) -> np.ndarray:
    """Standard deviation over the tasks of each group, (n_groups, 4); with n − 1, as of a sample."""
    values = np.array(result["after"][regret], float)
    return values.reshape(result["groups"], -1, values.shape[1]).std(axis=1, ddof=1)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Standard forms, learnt models, and the size of the difference of two pays; late deviations beside it."""
    found = by_method(results, DEFAULT)
    late = {f"late_{name}": mean_estimate(deviations(found[name], REGRETS[0])[:, -1]) for name in ("PI", "EI")}
    return pattern(found, "standard", REGRETS[0]) | late


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """Each form of the rules and meaning of regret in each reserve; PI as printed for PI's statement alone."""
    for place, found in each_place(settings, results):
        for form, regret in product(FORMS, REGRETS):
            numbers = pattern(found, form, regret)
            numbers = {"more_PI": numbers["more_PI"]} if form == PI_PRINTED else numbers
            yield {"form": form, "regret": regret, **place}, numbers


def pattern(found: Mapping[str, Mapping], form: str, regret: str) -> dict[str, Estimate]:
    """What the table shows, of the deviations of groups, paired: which fall, and which stay above the others."""
    of = {name: deviations(found[in_form(name, form)], regret) for name in STANDARD}

    def above_the_four(name: str) -> Estimate:
        differences = [mean_estimate(of[name][:, -1] - of[other][:, -1]) for other in CONVERGE]
        return min(differences, key=lambda difference: difference.value)

    inside = []
    for name, printed in PRINTED.items():
        low, high = np.quantile(of[name], [0.025, 0.975], axis=0)
        inside.append((low <= printed) & (printed <= high))
    return {
        **{f"fall_{name}": mean_estimate(of[name][:, 0] - of[name][:, -1]) for name in CONVERGE},
        "more_eps_greedy": above_the_four("ε-greedy"),
        "more_PI": above_the_four("PI"),
        "agree": share_of(np.ravel(inside)),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Median and middle 95 % of the groups' deviations, of each rule and of PI as printed."""
    found = by_method(results, DEFAULT)
    return [
        {"method": name, "quantiles": np.quantile(of, [0.025, 0.5, 0.975], axis=0).round(2).tolist()}
        for name in (*PRINTED, "PI, printed")
        for of in [deviations(found[name], REGRETS[0])]
    ]


@panels(9.2, 4.6, 2, 3, sharey=True)
def draw(result: Mapping, *every: Axes) -> None:
    """Printed standard deviations beside those of many groups of ten tasks (Table 4.3).

    A panel a rule: median and middle 95 % of groups, PI also as printed (dashed); diamonds: the table.
    """
    settings = result["settings"]
    places = range(len(AFTER))
    for axes, (name, printed) in zip(every, PRINTED.items(), strict=True):
        for row in result["rows"]:
            if row["method"].partition(",")[0] == name:
                low, middle, high = row["quantiles"]
                look = look_of(row["method"])
                axes.fill_between(places, low, high, color=look["color"], alpha=0.18, lw=0)
                axes.plot(places, middle, **look)
        axes.plot(places, printed, "D", color="white", mec=INK, ms=6, mew=1.2)
        axes.set_xticks(places, [str(k) for k in AFTER])
        axes.set(title=name, ylim=(0, None))
    figure = every[0].figure
    figure.supxlabel("after episode (diamonds: the printed table; band: middle 95 % of groups)", fontsize=9)
    figure.supylabel("standard deviation of regret", fontsize=9)
    figure.suptitle(f"{settings['groups']} groups of {settings['tasks']} tasks, learnt models", x=0.01, ha="left")
