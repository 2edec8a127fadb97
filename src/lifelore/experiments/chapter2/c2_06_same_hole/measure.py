"""Measures and rows of claim C2.6."""

from collections.abc import Mapping, Sequence

from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter2.c2_06_same_hole.hole_scenes import ARRANGEMENTS
from lifelore.experiments.engine.estimates import exact_share, mean_or_unmeasured

WITH_HOLE = ("hinged", "other")


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares of scenes by kind: with a hole found, any cycle, a passage in truth; and the holes' form."""
    scenes = {kind: _scenes(results, kind) for kind in (*ARRANGEMENTS, "real")}
    found = {}
    for kind in ARRANGEMENTS:
        found[f"hole_found_{kind}"] = exact_share(row["holes"] > 0 for row in scenes[kind])
    for kind in ARRANGEMENTS:
        found[f"any_cycle_{kind}"] = exact_share(row["loops"] > 0 for row in scenes[kind])
    for kind in ARRANGEMENTS:
        found[f"passage_in_truth_{kind}"] = exact_share(row["passages"] > 0 for row in scenes[kind])
    holes = [row for kind in WITH_HOLE for row in scenes[kind] if row["holes"]]
    found["found_where_the_passage_is"] = exact_share(row["real"] for row in holes)
    found["two_contacts_on_either_side"] = exact_share(row["form"] == [2, 2] for row in holes)
    found["exactly_one_hole"] = exact_share(row["holes"] == 1 for row in holes)
    for kind in WITH_HOLE:
        rows = [row for row in scenes[kind] if row["holes"]]
        found[f"loop_in_mm_{kind}"] = mean_or_unmeasured(row["size"] for row in rows)
    found["any_hole_in_a_real_scene"] = exact_share(row["holes"] > 0 for row in scenes["real"])
    return found


def _scenes(results: Sequence[Mapping], kind: str) -> list[Mapping]:
    return [row for result in results if result["kind"] == kind for row in result["scenes"]]


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """How often each outcome came, by kind and thing; and a picture of each kind."""
    outcomes: dict[tuple, int] = {}
    for result in results:
        for row in result["scenes"]:
            key = (result["kind"], row.get("thing", ""), row.get("loops", -1), row["holes"])
            outcomes[key] = outcomes.get(key, 0) + 1
    counted = [
        {"kind": kind, "thing": thing, "cycles": loops if loops >= 0 else None, "holes": holes, "scenes": n}
        for (kind, thing, loops, holes), n in sorted(outcomes.items())
    ]
    return counted + [example for result in results for example in result["examples"]]
