"""Measures and rows of claim C5.8: shares of objects grasped within a number of tries, and paired differences."""

from collections.abc import Mapping, Sequence

from lifelore.core.metrics import Estimate
from reproduction.chapter2.scenes.scene_lots import examples_in
from reproduction.chapter5.c5_02_functional_roles.ranking import mean_by_cluster
from reproduction.chapter5.c5_08_grasps.run import ARRANGEMENTS, TRIES
from reproduction.engine.estimates import UNMEASURED, exact_share

SEARCHES = ("seeded", "anywhere", "above")
TRANSFERS = ("carried", "copied", "not carried", "above, not carried")


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares within `TRIES` tries, and within one; differences on the same objects; intervals resample scenes."""
    seeded, moved = objects_with_seeds(results), objects_carried(results)
    found = {_key(name): share(seeded, name) for name in SEARCHES}
    found |= {_key(name): share(moved, name) for name in TRANSFERS}
    found |= {f"{_key(name)}_first_try": share(seeded, name, 1) for name in SEARCHES}
    found |= {f"{_key(name)}_first_try": share(moved, name, 1) for name in TRANSFERS}
    for name in ("anywhere", "above"):
        found[f"seeded_less_{name}"] = difference(seeded, "seeded", name)
    for name in TRANSFERS[1:]:
        found[f"carried_less_{_key(name)}"] = difference(moved, "carried", name)
    every = [row for result in results for row in result["objects"]]
    found["with_seeds"] = mean_by_cluster([float(row["seeds"] > 0) for row in every], [r["scene"] for r in every])
    found["equal_topology"] = exact_share(equal for result in results for equal in result["equal"])
    return found


def objects_with_seeds(results: Sequence[Mapping]) -> list[Mapping]:
    """Objects that have a seed; on these alone searches are compared."""
    return [row for result in results for row in result["objects"] if row["seeds"]]


def objects_carried(results: Sequence[Mapping]) -> list[Mapping]:
    """Objects to which a grasp that worked on their counterpart could be carried."""
    return [row for result in results for row in result["objects"] if "carried" in row]


def share(rows: Sequence[Mapping], name: str, tries: int = TRIES) -> Estimate:
    """Share of objects that a search grasps within a number of tries."""
    return _mean([_within(row, name, tries) for row in rows], rows)


def difference(rows: Sequence[Mapping], name: str, other: str) -> Estimate:
    """Share of one search less that of another on the same objects."""
    return _mean([_within(row, name, TRIES) - _within(row, other, TRIES) for row in rows], rows)


def _within(row: Mapping, name: str, tries: int) -> float:
    return float(row[name] is not None and row[name] <= tries)


def _mean(values: Sequence[float], rows: Sequence[Mapping]) -> Estimate:
    return mean_by_cluster(values, [row["scene"] for row in rows]) if rows else UNMEASURED


def _key(name: str) -> str:
    return name.replace(", ", "_").replace(" ", "_")


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Shares within 1, 2, … tries; shares by arrangement; pictures."""
    seeded, moved = objects_with_seeds(results), objects_carried(results)
    curves = [
        {"search": name, "within": [share(own, name, n).value for n in range(1, TRIES + 1)]}
        for own, names in ((seeded, SEARCHES), (moved, TRANSFERS))
        for name in names
        if own
    ]
    table = []
    for arrangement in ARRANGEMENTS:
        own = [result for result in results if result["arrangement"] == arrangement]
        row: dict = {"arrangement": arrangement}
        for part, names in ((objects_with_seeds(own), SEARCHES), (objects_carried(own), TRANSFERS)):
            row |= {name: [sum(_within(r, name, TRIES) for r in part), len(part)] for name in names}
        table.append(row)
    return curves + table + examples_in(results)
