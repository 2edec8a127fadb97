"""Measures and rows of claim C3.14."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from lifelore.action.search.domain_reduction import FORMS
from lifelore.core.metrics import Estimate, ratio_estimate
from reproduction.chapter3.c3_14_minimised_domains.minimised_worlds import WITH_SINKS
from reproduction.chapter3.c3_14_minimised_domains.run import WHOLE, WITHIN
from reproduction.engine.estimates import UNMEASURED, mean_or_unmeasured, share_of
from reproduction.engine.results_table import ResultsTable

REPAIRED, PRINTED, CLOSED = WITHIN[0], *WITHIN[2:]


def _tables(results: Sequence[Mapping]) -> tuple[ResultsTable, ResultsTable]:
    """Sets of tasks, and learning in every domain under every schedule."""
    learning = ResultsTable.nested(results, "learning", ("form", "dead_ends", "schedule"), ("kind",))
    return ResultsTable.nested(results, "exact", (), ("kind",)), learning


def _tasks(sets: ResultsTable, form: str) -> list[Mapping]:
    """All tasks of the sets in a minimised domain."""
    return [task for of_set in sets.records for task in of_set[form]["tasks"]]


def _ratio(learning: ResultsTable, way: tuple[str, str], measure: str, kind: str, schedule) -> Estimate:
    """A number of a minimised domain over that of the whole domain, paired by run."""
    within, whole = ({"form": form, "dead_ends": ends} for form, ends in (way, (WHOLE, "")))
    return learning.ratio(measure, within, whole, kind=kind, schedule=schedule)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """What the minimised domains keep, their traps, and the kinds of worlds in which the claim fares worst."""
    sets, learning = _tables(results)
    measured = {"undefined_printed": share_of([r["printed"]["undefined"] > 0 for r in sets.records])}

    def worst_ratio(measure: str, way: tuple[str, str]) -> Estimate:
        schedule = settings["default"]["schedule"]
        return worst(_ratio(learning, way, measure, kind, schedule) for kind in settings["kinds"])

    for way in (REPAIRED, PRINTED, CLOSED):
        form, ending = way[0], "" if way == REPAIRED else f"_{way[0]}"
        tasks = _tasks(sets, form)
        measured[f"theorem_{form}"] = share_of([t["return_kept"] and t["policy_kept"] for t in tasks])
        measured[f"more_traps{ending}"] = share_of([t["traps_within"] > t["traps"] for t in tasks])
        measured |= {f"{name}{ending}": number for name, number in _traps(settings, sets, form).items()}
        measured[f"to_80_ratio_worst{ending}"] = worst_ratio("to_80", way)
    collisions = (worst_ratio("explored_collisions", way) for way in (REPAIRED, PRINTED))
    return measured | {"collisions_ratio_worst": worst(collisions)}


def _traps(settings: Mapping, sets: ResultsTable, form: str) -> dict[str, Estimate]:
    """Changes in traps where the domain has some, a number for each set; new traps where it has none (E36)."""
    with_traps, new_traps = [], []
    for kind in settings["kinds"]:
        for of_set in sets.select(kind=kind).records:
            tasks = of_set[form]["tasks"]
            some = [t for t in tasks if t["traps"]]
            if kind in WITH_SINKS and some:
                keys = ("traps", "traps_left", "traps_within")
                with_traps.append([np.mean([t[key] for t in some]) for key in keys])
            new_traps += [t["traps_within"] > 0 for t in tasks if not t["traps"]]
    whole, left, within = np.array(with_traps).reshape(-1, 3).T
    return {
        "trap_difference_with_traps": mean_or_unmeasured(within - whole),
        "own_traps_left": ratio_estimate(left, whole) if len(whole) else UNMEASURED,
        "traps_where_none": share_of(new_traps) if new_traps else UNMEASURED,
    }


def worst(ratios: Iterable[Estimate]) -> Estimate:
    """The ratio whose interval reaches highest; NaN is the worst of all.

    The interval of a ratio that is the same in every run is the ratio itself.
    """
    whole = [replace(r, ci95=(r.value, r.value)) if r.ci95 is None and r.n >= 3 else r for r in ratios]
    return max(whole, key=lambda r: np.inf if np.isnan(r.value) else r.ci95[1] if r.ci95 else r.value)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Kind by kind: what is kept and traps; then every domain under every schedule."""
    (all_sets, learning), found = _tables(results), []
    for kind in settings["kinds"]:
        sets = all_sets.select(kind=kind)
        row: dict = {"kind": kind, "sets": len(sets)}
        for form in FORMS:
            tasks = _tasks(sets, form)
            row[form] = {key: float(np.mean([t[key] for t in tasks])) for key in ("return_kept", "policy_kept")}
            row[form]["defined"] = float(np.mean([r[form]["undefined"] == 0 for r in sets.records]))
            row[form]["no_more_traps"] = float(np.mean([t["traps_within"] <= t["traps"] for t in tasks]))
            for key in ("traps", "traps_left", "traps_within", "states"):
                row[form][key] = float(np.mean([t[key] for t in tasks]))
        found.append(row)
    keys = ("explored_collisions", "explored_reached", "to_80", "first_ten", "regret", "collisions")
    ways: list[tuple[str, str]] = [(WHOLE, ""), *WITHIN]
    for (kind, schedule), way in product(product(settings["kinds"], settings["schedules"]), ways):
        about = {"form": way[0], "dead_ends": way[1], "schedule": schedule}
        of_way = learning.select(kind=kind, **about)
        row = {"learnt_in": kind, **about, **{key: of_way.mean(key).to_dict() for key in keys}}
        row["never_80"] = int(of_way.values("never_80").sum())
        found.append(row | {"to_80_ratio": _ratio(learning, way, "to_80", kind, schedule).to_dict()})
    return found
