"""Measures and rows of claim C4.5."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter4.c4_01_golf_example.measure import known
from lifelore.experiments.chapter4.c4_05_selection_rules.run import worlds
from lifelore.experiments.chapter4.reuse_rules import OF_THESIS
from lifelore.experiments.chapter4.reuse_runs import STUCK, plain
from lifelore.experiments.chapter4.surveillance_runs import CASES, DEFAULT_WORLD, RULES, find, name_of, summary
from lifelore.experiments.engine.estimates import exact_share, share_of

ALL = 68
"""Episodes that trying every policy takes."""
WITHIN = 15
CONVERGE = ("BE", "KG", "sampling")


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
