"""Measures and rows of claim C2.9."""

from collections.abc import Mapping, Sequence

from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter2.c2_09_substructure.run import HOSTS, READINGS
from lifelore.experiments.engine.estimates import exact_share, mean_or_unmeasured

SEARCHES = (*HOSTS, "reversed")


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Share of stacks found in each kind of scene, by reading; whether the witness is right; contact points."""
    drawn = [row for result in results if not result["real"] for row in result["scenes"]]
    real = [row for result in results if result["real"] for row in result["scenes"]]
    found = {}
    for where in SEARCHES:
        for name in ("connected", *READINGS):
            found[_name(where, name)] = exact_share(row[where][name] for row in drawn)
    found["witness_right"] = exact_share(row["witness"] for row in drawn if row["witness"] is not None)
    for name in READINGS:
        found[f"real_stack_in_two_contacts_{name}"] = exact_share(row["two contacts"][name] for row in real)
    for place, what in enumerate(("stack", *HOSTS)):
        found[f"contact_points_{what.replace(' ', '_')}"] = mean_or_unmeasured(
            row["points"][place] for row in drawn
        )
    return found


def _name(where: str, reading: str) -> str:
    return f"{'two_contacts_in_stack' if where == 'reversed' else 'in_' + where.replace(' ', '_')}_{reading}"


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """How often each set of answers came; and three pictures."""
    counts: dict[tuple, int] = {}
    for result in results:
        for row in result["scenes"]:
            for where in SEARCHES:
                if where in row:
                    key = (result["real"], where, *(row[where][name] for name in READINGS))
                    counts[key] = counts.get(key, 0) + 1
    counted = [
        {"real": real, "in": where, **dict(zip(READINGS, answers, strict=True)), "scenes": n}
        for (real, where, *answers), n in sorted(counts.items())
    ]
    return counted + [example for result in results for example in result["examples"]]
