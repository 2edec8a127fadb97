"""C4.5: six ways to select among 68 policies in the surveillance reserve, and how soon each converges.

Headline: models learnt from `samples` deployments a pair, and every second task's poachers at a place that is no
target. Beside it learnt models on targets alone, and exact models. Standard forms of the rules count; the forms as
printed run beside them, as does information-directed sampling, which the thesis does not have. The thesis leaves
open the cells around a hill, the distance, and whether 20 is a deviation or a variance: the grid has them all.

A task has converged after the first episode from which on its regret is none; a rule converges by the median over
tasks, and fails to where the median of a task's mean regret over the last ten episodes exceeds 5.

Thesis: §4.6.4, Figures 4.9 and 4.10.
"""

from collections.abc import Iterable, Mapping

from lifelore.core.errors import InputError
from lifelore.domains.surveillance.surveillance import LAYOUTS, METRICS, NOISES
from lifelore.experiments.chapter4.surveillance_runs import CASES, DEFAULT_WORLD, RULES, run_method
from lifelore.experiments.engine.learning_settings import check_among, check_counts


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
