"""C4.5: ways to select among 68 policies in the surveillance reserve. Thesis: §4.6.4, Figure 4.10."""

from collections.abc import Iterator, Mapping, Sequence

from lifelore.core.metrics import Estimate
from lifelore.figures.style import Axes
from reproduction.chapter4.reuse.looks import draw_linear
from reproduction.chapter4.reuse.many_tasks import grouped_mean, grouped_quantile
from reproduction.chapter4.reuse.rules import FORMS, PI_PRINTED, RULES, STANDARD, in_form
from reproduction.chapter4.surveillance.runs import DEFAULT, READ, by_group, by_method, each_place, reserve_cells
from reproduction.chapter4.surveillance.runs import run_method as run_cell
from reproduction.figures.panels import panels

__all__ = ["cells", "readings", "rows", "run_cell", "shared"]
shared = READ
SHOWN = (*STANDARD, "PI, printed")


def cells(settings: Mapping) -> list[dict]:
    """Every rule in both forms: learnt models in the default reserve, exact ones in every reserve."""
    return reserve_cells(settings, RULES)


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """Each form of the rules in each reserve, with exact models; learnt ones in the default.

    PI as printed beside standard rules is a reading of PI's statement alone.
    """
    for place, found in each_place(settings, results):
        for form in FORMS:
            numbers = convergence(found, form)
            yield {"form": form, **place}, {"late_PI": numbers["late_PI"]} if form == PI_PRINTED else numbers


def convergence(found: Mapping[str, Mapping], form: str) -> dict[str, Estimate]:
    """When regret ended, how much was left, and how much more the next best rule has than EI, paired by task."""
    of = {name: found[in_form(name, form)] for name in STANDARD}
    sums = {name: by_group(result, "sums") for name, result in of.items()}
    best_other = min((name for name in of if name != "EI"), key=lambda name: sums[name].mean())
    ended = ("BE", "KG", "sampling", "EI")
    late = {"late_PI": "PI", "late_eps_greedy": "ε-greedy"}
    return {
        **{f"ended_{name}": grouped_quantile(by_group(of[name], "ended"), 0.5) for name in ended},
        **{key: grouped_quantile(by_group(of[name], "late"), 0.5) for key, name in late.items()},
        "next_minus_EI": grouped_mean(sums[best_other] - sums["EI"]),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Curves of ten tasks with learnt models."""
    found = by_method(results, DEFAULT)
    return [
        {"method": name, "entropy": found[name]["entropy"], "regret": found[name]["curves"][0]["mean"]}
        for name in SHOWN
    ]


@panels(9.2, 3.8, 1, 2, grid="")
def draw(result: Mapping, left: Axes, right: Axes) -> None:
    """Six ways to select among 68 policies: entropy of the belief and regret after each episode (Figure 4.10).

    The thesis's panels (a) and (b): means of ten tasks.
    """
    rows, settings = result["rows"], result["settings"]
    draw_linear(left, {row["method"]: row["entropy"] for row in rows}, 0, title="(a) Entropy of the belief (nats)")
    draw_linear(right, {row["method"]: row["regret"] for row in rows}, 1, title="(b) Regret")
    for axes in (left, right):
        axes.set_xlabel("episode")
    left.figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=len(rows))
    left.figure.suptitle(f"Surveillance, {settings['tasks']} random tasks, learnt models", x=0.01, ha="left")
