"""C4.5: when the regret of each rule ends, and in how many reserves the statements of the thesis hold."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate
from reproduction.chapter4.reuse.many_tasks import STUCK, grouped_mean, grouped_quantile
from reproduction.chapter4.reuse.rules import OF_THESIS, STANDARD
from reproduction.chapter4.surveillance import runs
from reproduction.chapter4.surveillance.runs import (
    CASES,
    DOUBTING,
    RULES,
    by_group,
    by_seen,
    find,
    name_of,
    summary,
)
from reproduction.engine.estimates import exact_share, exact_value, interval_or_value, is_above, share_of

ALL = 68
"""Episodes that trying every policy takes."""
WITHIN, QUARTER = 15, 17
"""Episodes: "about 15", and "approximately a quarter" of `ALL`."""
CONVERGE, FAIL = ("BE", "KG", "sampling"), ("PI", "eps-greedy")
READ = dict.fromkeys(CONVERGE, "ended_median") | dict.fromkeys(FAIL, "late_median")
"""The number that conditions read, by rule in its standard or printed form."""


def verdicts(found: Mapping[str, Mapping[str, Estimate]], printed: bool = False) -> dict[str, bool]:
    """The figure's statements, each true or false, of six rules' summaries; `printed` takes the printed forms."""
    of = {
        name: found[f"{name}, printed" if printed and f"{name}, printed" in found else name] for name in OF_THESIS
    }
    ended = {name: numbers["ended_median"].value for name, numbers in of.items()}
    return {
        **{f"{name} converges": ended[name] <= WITHIN for name in CONVERGE},
        "EI fastest": ended["EI"] <= min(ended.values()),
        **{f"{name} fails": of[name]["late_median"].value > STUCK for name in FAIL},
    }


def in_form(name: str, printed: bool) -> str:
    """A rule's printed form where it has one and `printed` asks for it, else its standard form."""
    return f"{name}, printed" if printed and f"{name}, printed" in RULES else name


def sooner_than_next(found: Mapping[str, Mapping], printed: bool = False) -> Estimate:
    """By how many episodes EI converges sooner than the soonest other of the six, paired by task (means).

    `found`: of each rule the result of its cell.
    """
    ended = {name: by_group(found[in_form(name, printed)], "ended") for name in OF_THESIS}
    others = [grouped_mean(ended[name] - ended["EI"]) for name in OF_THESIS if name != "EI"]
    return min(others, key=lambda number: number.value)


def all_certain(found: Mapping[str, Mapping], printed: bool) -> bool:
    """Whether every statement of the figure holds by its whole 95 % interval."""
    of = {name: found[in_form(name, printed)] for name in OF_THESIS}
    soon = [interval_or_value(grouped_quantile(by_group(of[name], "ended"), 0.5))[1] for name in CONVERGE]
    fail = [interval_or_value(grouped_quantile(by_group(of[name], "late"), 0.5))[0] for name in FAIL]
    return max(soon) <= QUARTER and min(fail) > STUCK and is_above(sooner_than_next(found, printed), 0.0)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """When regret ended and how much was left, by case; the share of reserves and of small runs that agree."""
    measured: dict[str, Estimate] = {}
    certain: list[bool] = []
    for name in STANDARD:
        for case in (*DOUBTING, "learnt", "headline"):
            numbers = by_seen(find(results, name, case))
            measured |= {f"{key}_{name_of(name, case)}": number for key, number in numbers.items()}
    for case in CASES:
        if case in DOUBTING:
            continue
        cells = {name: find(results, name, case) for name in RULES}
        found = {name: summary(cell) for name, cell in cells.items()}
        certain += [all_certain(cells, printed) for printed in (False, True) if case != "exact"]
        measured[f"EI_sooner_than_next_{name_of('', case).strip('_')}"] = sooner_than_next(cells)
        for name, numbers in found.items():
            if key := READ.get(name.partition(",")[0]):
                measured[f"{key}_{name_of(name, case)}"] = numbers[key]
        measured["stuck_" + name_of("EI, printed", case)] = found["EI, printed"]["stuck"]
        measured |= _comparisons(name_of("", case).strip("_"), found)
    worlds = runs.worlds(settings)
    grid_cells = [{name: find(results, name, "exact", **world) for name in RULES} for world in worlds]
    certain += [all_certain(cells, printed) for cells in grid_cells for printed in (False, True)]
    measured["grid_statements_certain"] = share_of(certain)
    grid = [{name: summary(cell) for name, cell in cells.items()} for cells in grid_cells]
    small = [_summaries_of_group(settings, results, group) for group in range(settings["groups"])]
    for form, printed in (("", False), ("_printed", True)):
        answers = [verdicts(found, printed) for found in grid]
        measured[f"grid_all{form}"] = share_of([all(found.values()) for found in answers])
        of_groups = [verdicts(found, printed) for found in small]
        for statement in answers[0]:
            name = statement.replace(" ", "_").replace("-", "_") + form
            measured[f"grid_{name}"] = share_of([found[statement] for found in answers])
            measured[f"thesis_size_{name}"] = exact_share(found[statement] for found in of_groups)
    return measured


def _summaries_of_group(settings: Mapping, results: Sequence[Mapping], group: int) -> dict[str, dict]:
    """Summaries of one group of tasks, an experiment of the thesis's size; exact models."""

    def part_of(result: Mapping) -> dict:
        own = slice(group * settings["tasks"], (group + 1) * settings["tasks"])
        return {**result, **{key: result[key][own] for key in ("sums", "ended", "late")}, "groups": 1}

    return {name: summary(part_of(find(results, name, "exact"))) for name in RULES}


def _comparisons(case: str, found: Mapping[str, Mapping[str, Estimate]]) -> dict[str, Estimate]:
    """Differences between the medians of rules, and the slowest of three as a share of trying every policy."""
    ended = {name: numbers["ended_median"].value for name, numbers in found.items()}
    others = min(ended[name] for name in OF_THESIS if name != "EI")
    return {
        f"EI_minus_fastest_other_{case}": exact_value(ended["EI"] - others),
        f"EI_printed_minus_fastest_other_{case}": exact_value(ended["EI, printed"] - others),
        f"slowest_of_three_share_of_all_{case}": exact_value(max(ended[name] for name in CONVERGE) / ALL),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a cell: its summary, over the grid its values; in the default reserve also its curves and late regret
    on unseen tasks."""
    found = []
    for result in results:
        row = runs.row_of(result)
        if runs.is_default(row):
            row |= {"curve": result["curve"], "entropy": result.get("entropy")}
            row["late_by_seen"] = late_by_seen(result)
        else:
            row |= {key: {"value": n["value"]} for key, n in row.items() if isinstance(n, dict)}
        found.append(row)
    return found


def late_by_seen(result: Mapping) -> dict[str, float]:
    """Mean regret over the last ten episodes on tasks at targets, and on others where there are some."""
    late, seen = np.array(result["late"]), np.array(result["seen"], bool)
    return {
        word: round(float(late[which].mean()), 3)
        for word, which in (("seen", seen), ("unseen", ~seen))
        if which.any()
    }
