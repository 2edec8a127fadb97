"""Measures and rows of claim C3.14."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from lifelore.action.search.domain_reduction import FORMS
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.experiments.chapter3.c3_14_minimised_domains.minimised_worlds import EVERY_START, WITH_SINKS
from lifelore.experiments.chapter3.c3_14_minimised_domains.run import WHOLE, WITHIN
from lifelore.experiments.engine.estimates import UNMEASURED, is_below, mean_or_unmeasured, share_of

DEFAULT_WAY, PRINTED_WAY, CLOSED_WAY = WITHIN[0], *WITHIN[2:]
Learning = Mapping


def _sets(results: Sequence[Mapping], kind: str | None = None) -> list[Mapping]:
    """Every set of tasks, exactly."""
    return [one for r in results if kind in (None, r["kind"]) for one in r["exact"]]


def _tasks(results: Sequence[Mapping], form: str, kind: str | None = None) -> list[Mapping]:
    return [task for one in _sets(results, kind) for task in one[form]["tasks"]]


def _learnt(results: Sequence[Mapping], kind: str, way: tuple[str, str], schedule) -> list[Learning]:
    """Learning of one kind in one domain under one schedule, run by run."""
    return [
        numbers
        for result in results
        if result["kind"] == kind
        for numbers in result["learning"]
        if (numbers["form"], numbers["dead_ends"]) == way and numbers["schedule"] == schedule
    ]


def _ratio(results: Sequence[Mapping], kind: str, way: tuple[str, str], schedule, key: str) -> Estimate:
    """A number of the minimised domain over that of the domain, paired by run."""
    within, whole = ([n[key] for n in _learnt(results, kind, w, schedule)] for w in (way, (WHOLE, "")))
    return ratio_estimate(within, whole)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """What is kept, traps, exploration and learning; over all kinds, and kind by kind."""
    measured = {}
    for form in FORMS:
        tasks = _tasks(results, form)
        for key in ("return_kept", "policy_kept"):
            measured[f"{key}_{form}"] = share_of([t[key] for t in tasks])
        both = [t["return_kept"] and t["policy_kept"] for t in tasks]
        measured[f"theorem_{form}"] = share_of(both)
        for key in ("undefined", "renormalised"):
            measured[f"{key}_{form}"] = share_of([one[form][key] > 0 for one in _sets(results)])
        measured[f"more_traps_{form}"] = share_of([t["traps_within"] > t["traps"] for t in tasks])
    measured["more_traps"] = measured.pop("more_traps_repaired")
    measured |= _traps(settings, results)
    return measured | dict(_by_kind(settings, results)) | _worst(settings, results)


def _traps(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Changes in traps where the domain has some, a set of tasks each a number; and E36 where it has none."""
    found = {}
    for form, suffix in (("repaired", ""), ("printed", "_printed"), ("closed", "_closed")):
        having, none = [], []
        for kind in settings["kinds"]:
            for one in _sets(results, kind):
                each = one[form]["tasks"]
                some = [t for t in each if t["traps"]]
                if kind in WITH_SINKS and some:
                    having.append(
                        [np.mean([t[key] for t in some]) for key in ("traps", "traps_left", "traps_within")]
                    )
                none += [t["traps_within"] > 0 for t in each if not t["traps"]]
        columns = np.array(having).reshape(-1, 3)
        found[f"trap_difference_with_traps{suffix}"] = mean_or_unmeasured(columns[:, 2] - columns[:, 0])
        left = ratio_estimate(columns[:, 1], columns[:, 0]) if len(columns) else UNMEASURED
        found[f"own_traps_left{suffix}"] = left
        found[f"traps_where_none{suffix}"] = share_of(none) if none else UNMEASURED
    return found


def _by_kind(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[str, Estimate]]:
    schedule = settings["default"]["schedule"]
    for kind in settings["kinds"]:
        name = _name(kind)
        tasks = _tasks(results, "repaired", kind)
        yield f"more_traps_{name}", share_of([t["traps_within"] > t["traps"] for t in tasks])
        printed = _tasks(results, "printed", kind)
        yield f"more_traps_printed_{name}", share_of([t["traps_within"] > t["traps"] for t in printed])
        yield f"undefined_printed_{name}", share_of([s["printed"]["undefined"] > 0 for s in _sets(results, kind)])
        yield f"pairs_kept_{name}", mean_estimate([s["repaired"]["pairs"] for s in _sets(results, kind)])
        yield f"collisions_ratio_{name}", _ratio(results, kind, DEFAULT_WAY, schedule, "explored_collisions")
        yield f"reached_ratio_{name}", _ratio(results, kind, DEFAULT_WAY, schedule, "explored_reached")
        for way in WITHIN:
            ratio = _ratio(results, kind, way, schedule, "to_80")
            yield f"to_80_ratio_{name}{'' if way == DEFAULT_WAY else '_' + '_'.join(way)}", ratio
        for suffix, way in (("domain", (WHOLE, "")), ("minimised", DEFAULT_WAY)):
            learnt = _learnt(results, kind, way, schedule)
            for key in ("to_80", "never_80", "collisions"):
                yield f"{key}_{suffix}_{name}", mean_estimate([float(n[key]) for n in learnt])


def _name(kind: str) -> str:
    return kind.replace(",", "").replace(" ", "_")


def _worst(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The kinds of worlds in which the claim fares worst, and the share of kinds that are faster for certain."""
    schedule = settings["default"]["schedule"]

    def ratios(kinds, key, way=DEFAULT_WAY):
        return [_ratio(results, kind, way, schedule, key) for kind in kinds]

    to_80 = ratios(settings["kinds"], "to_80")
    every_start = [kind for kind in settings["kinds"] if kind in EVERY_START]
    found = {"to_80_ratio_worst_every_start": worst(ratios(every_start, "to_80"))}
    collisions = []
    for suffix, way in (("", DEFAULT_WAY), ("_printed", PRINTED_WAY), ("_closed", CLOSED_WAY)):
        found[f"to_80_ratio_worst{suffix}"] = worst(ratios(settings["kinds"], "to_80", way))
        collisions.append(worst(ratios(settings["kinds"], "explored_collisions", way)))
        found[f"collisions_ratio_worst_{way[0]}"] = collisions[-1]
    found["collisions_ratio_worst"] = worst(collisions[:2])
    return found | {"faster_kinds": share_of([is_below(ratio, 1.0) for ratio in to_80])}


def worst(ratios: Sequence[Estimate]) -> Estimate:
    """The ratio whose interval reaches highest; one that is no number is the worst of all.

    A ratio that is the same in every run is its own interval.
    """
    whole = [replace(r, ci95=(r.value, r.value)) if r.ci95 is None and r.n >= 3 else r for r in ratios]
    return max(whole, key=lambda r: np.inf if np.isnan(r.value) else r.ci95[1] if r.ci95 else r.value)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Kind by kind: what is kept and traps; then every domain under every schedule."""
    found = []
    for kind in settings["kinds"]:
        row = {"kind": kind, "sets": len(_sets(results, kind))}
        for form in FORMS:
            tasks = _tasks(results, form, kind)
            row[form] = {key: float(np.mean([t[key] for t in tasks])) for key in ("return_kept", "policy_kept")}
            row[form]["defined"] = float(np.mean([s[form]["undefined"] == 0 for s in _sets(results, kind)]))
            row[form]["no_more_traps"] = float(np.mean([t["traps_within"] <= t["traps"] for t in tasks]))
            for key in ("traps", "traps_left", "traps_within", "states"):
                row[form][key] = float(np.mean([t[key] for t in tasks]))
        found.append(row)
    for kind in settings["kinds"]:
        for schedule in settings["schedules"]:
            for way in ((WHOLE, ""), *WITHIN):
                found.append(_learning_row(results, kind, way, schedule))
    return found


def _learning_row(results: Sequence[Mapping], kind: str, way: tuple[str, str], schedule) -> dict:
    learnt = _learnt(results, kind, way, schedule)
    row = {"learnt_in": kind, "form": way[0], "dead_ends": way[1], "schedule": schedule}
    for key in ("explored_collisions", "explored_reached", "to_80", "first_ten", "regret", "collisions"):
        row[key] = mean_estimate([n[key] for n in learnt]).to_dict()
    row["never_80"] = int(sum(n["never_80"] for n in learnt))
    row["to_80_ratio"] = _ratio(results, kind, way, schedule, "to_80").to_dict()
    return row
