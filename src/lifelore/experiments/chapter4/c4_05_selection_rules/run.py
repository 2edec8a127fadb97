"""C4.5: six ways to select among 68 policies in the surveillance reserve, and how soon each converges.

Headline: models learnt from `samples` deployments a pair, and every second task's poachers at a place that is no
target. Beside it learnt models on targets alone, and exact models. Standard forms of the rules count; the forms as
printed run beside them, as does information-directed sampling, which the thesis does not have. The thesis leaves
open the cells around a hill, the distance, and whether 20 is a deviation or a variance: the grid has them all.

A task has converged after the first episode from which on its regret is none; a rule converges by the median over
tasks, and fails to where the median of a task's mean regret over the last ten episodes exceeds 5.

Thesis: §4.6.4, Figures 4.9 and 4.10.
"""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from lifelore.domains.surveillance.surveillance import LAYOUTS, METRICS, NOISES
from lifelore.experiments.chapter4.c4_01_golf_example.run import known
from lifelore.experiments.chapter4.reuse_rules import OF_THESIS
from lifelore.experiments.chapter4.reuse_runs import STUCK, plain
from lifelore.experiments.chapter4.surveillance_runs import (
    CASES,
    DEFAULT_WORLD,
    RULES,
    find,
    name_of,
    run_method,
    summary,
)
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.estimates import exact_share, share_of
from lifelore.experiments.engine.learning_settings import check_among, check_counts
from lifelore.experiments.engine.predicate import Predicate

FULL = {
    "tasks": 10,
    "groups": 30,
    "grid_groups": 15,
    "episodes": 50,
    "samples": 10,
    "layouts": list(LAYOUTS),
    "metrics": list(METRICS),
    "noises": list(NOISES),
    "after": [5, 10, 20, 50],
}
QUICK = {**FULL, "groups": 3, "grid_groups": 3, "episodes": 15, "layouts": ["X"], "metrics": ["chebyshev"]}
ALL = 68
"""Episodes that trying every policy takes."""
WITHIN = 15
CONVERGE = ("BE", "KG", "sampling")


def check(settings: Mapping) -> None:
    """Counts, and choices that include the default reserve."""
    check_counts(settings, ("tasks", "groups", "episodes", "samples", "after"))
    for key, known_ones in (("layouts", LAYOUTS), ("metrics", METRICS), ("noises", NOISES)):
        if key in settings:
            check_among(settings, key, tuple(known_ones))
            if DEFAULT_WORLD[key[:-1]] not in settings[key]:
                raise InputError(f"{key} must include the default, {DEFAULT_WORLD[key[:-1]]}")


def cells(settings: Mapping) -> list[dict]:
    """Every rule in every case of the default reserve, and with exact models on targets in every other."""
    return reserve_cells(settings, CASES, RULES, RULES)


def reserve_cells(
    settings: Mapping, cases: Iterable[str], methods: Iterable[str], in_grid: Iterable[str]
) -> list[dict]:
    """`methods` in all `cases` of the default reserve; `in_grid`, with exact models on targets, in every other."""
    default = [
        {"method": name, "case": case, **DEFAULT_WORLD, "groups": settings["groups"]}
        for case in cases
        for name in methods
    ]
    grid = [
        {"method": name, "case": "exact", **world, "groups": settings["grid_groups"]}
        for world in worlds(settings)
        if world != DEFAULT_WORLD
        for name in in_grid
    ]
    return default + grid


def worlds(settings: Mapping) -> list[dict[str, str]]:
    """Every reserve of the grid."""
    return [
        {"layout": layout, "metric": metric, "noise": noise}
        for layout in settings["layouts"]
        for metric in settings["metrics"]
        for noise in settings["noises"]
    ]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One rule on all its tasks."""
    return run_method(settings, cell, seed)


def verdicts(found: Mapping[str, Mapping[str, Estimate]], printed: bool = False) -> dict[str, bool]:
    """The figure's statements, each true or false, of six rules' summaries; `printed` takes the printed forms."""
    of = {
        name: found[f"{name}, printed" if printed and f"{name}, printed" in found else name] for name in OF_THESIS
    }
    ended = {name: numbers["ended_median"].value for name, numbers in of.items()}
    return {
        **{f"{name} converges": ended[name] <= WITHIN for name in CONVERGE},
        "EI fastest": ended["EI"] <= min(ended.values()),
        **{f"{name} fails": of[name]["late_median"].value > STUCK for name in ("PI", "eps-greedy")},
    }


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Of each case and rule when regret ended and how much there was; and in how much of the grid this is so."""
    measured: dict[str, Estimate] = {}
    for case in CASES:
        found = {name: summary(find(results, name, case)) for name in RULES}
        for name, numbers in found.items():
            measured |= {f"{key}_{name_of(name, case)}": number for key, number in numbers.items()}
        measured |= _of_case(case, found)
    grid = {"": [], "_printed": []}
    for world in worlds(settings):
        found = {name: summary(find(results, name, "exact", **world)) for name in RULES}
        grid[""].append(verdicts(found))
        grid["_printed"].append(verdicts(found, printed=True))
    measured |= _of_thesis_size(settings, results)
    for form, answers in grid.items():
        for statement in answers[0]:
            name = statement.replace(" ", "_").replace("-", "_")
            measured[f"grid_{name}{form}"] = share_of([one[statement] for one in answers])
        measured[f"grid_all{form}"] = share_of([all(one.values()) for one in answers])
    return measured


def _of_thesis_size(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """In what share of experiments with one group of tasks each, as in the thesis, the statements are true."""
    measured: dict[str, Estimate] = {}
    for form, printed in (("", False), ("_printed", True)):
        answers = []
        for group in range(settings["groups"]):
            own = slice(group * settings["tasks"], (group + 1) * settings["tasks"])
            found = {}
            for name in RULES:
                result = find(results, name, "exact")
                kept = {key: result[key][own] for key in ("sums", "ended", "late")}
                found[name] = summary({**result, **kept, "groups": 1})
            answers.append(verdicts(found, printed))
        for statement in answers[0]:
            name = statement.replace(" ", "_").replace("-", "_")
            measured[f"thesis_size_{name}{form}"] = exact_share([one[statement] for one in answers])
    return measured


def _of_case(case: str, found: Mapping[str, Mapping[str, Estimate]]) -> dict[str, Estimate]:
    """What compares rules with one another: numbers of one case, or differences of its medians."""
    ended = {name: numbers["ended_median"].value for name, numbers in found.items()}
    others = min(ended[name] for name in OF_THESIS if name != "EI")
    short = name_of("", case).strip("_")
    return {
        f"EI_minus_fastest_other_{short}": known(ended["EI"] - others),
        f"EI_printed_minus_fastest_other_{short}": known(ended["EI, printed"] - others),
        f"slowest_of_three_share_of_all_{short}": known(max(ended[name] for name in CONVERGE) / ALL),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a cell: its summary, over the grid its values; in the default reserve also its curves and late regret
    on unseen tasks."""
    kept = []
    for result in results:
        world = {key: result[key] for key in DEFAULT_WORLD}
        numbers = plain(summary(result))
        if world != DEFAULT_WORLD:
            numbers = {name: {"value": number["value"]} for name, number in numbers.items()}
        row = {"method": result["method"], "case": result["case"], **world, **numbers}
        if world == DEFAULT_WORLD:
            row |= {"curve": result["curve"], "entropy": result.get("entropy")}
            row["late_by_seen"] = late_by_seen(result)
        kept.append(row)
    return kept


def late_by_seen(result: Mapping) -> dict[str, float]:
    """Mean regret over the last ten episodes on tasks at targets, and on others where there are some."""
    late, seen = np.array(result["late"]), np.array(result["seen"], bool)
    return {
        word: round(float(late[which].mean()), 3)
        for word, which in (("seen", seen), ("unseen", ~seen))
        if which.any()
    }


def _draw(result: Mapping):
    from lifelore.experiments.chapter4.selection_curves import draw_selection_curves

    return draw_selection_curves(result)


CAUSES = {
    "PI fails, exact": "with the probability of exceeding the best possible mean the rule converges; it fails "
    "with the printed density just above the best expected pay, where pays far above count as little as far below",
    "PI fails, headline": "as with exact models; and unequal learnt deviations break ties between empty places",
    "sampling converges, headline": "at a place that is no target two policies are often nearly as good, and "
    "sampling keeps going from one to the other",
    "a quarter, headline": "the slowest is sampling the belief, on unseen tasks",
    "EI fastest, headline": "it looks again and again at neighbours of the best, which on unseen tasks pay nearly "
    "as much; its regret summed over the episodes is the least of the six all the same",
    "EI as printed, never stuck": "it asks how likely a pay above the best expected one is and not how far above, "
    "and stays at a hilltop for ever",
    "BE as printed converges": "the printed vector sums to more than one, and its entropy has little to do with "
    "what a survey tells",
    "KG as printed converges": "averaged over signals before the maximum the gain is zero, so greedy is left",
}

CLAIM = Claim(
    id="C4.5",
    title="Six ways to select, 68 surveillance tasks (Figure 4.10)",
    thesis="BPR-BE, BPR-KG and sampling the belief converge in about 15 episodes, about a quarter of what trying "
    "every policy takes; BPR-EI converges fastest; BPR-PI and ε-greedy selection (0.3) do not converge in 50 "
    "episodes (10 random tasks).",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C4.5"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes=CAUSES,
    check=check,
)
