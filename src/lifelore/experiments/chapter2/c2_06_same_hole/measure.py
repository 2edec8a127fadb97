"""Measures and rows of claim C2.6: scenes with a hole, by kind, and the form and place of the holes."""

from collections.abc import Mapping, Sequence

from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter2.c2_06_same_hole.run import ARRANGEMENTS
from lifelore.experiments.engine.estimates import exact_share
from lifelore.experiments.engine.results_table import ResultsTable, tally

WITH_HOLE = ("hinged", "other")


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares of scenes by kind with a hole found, and with a passage in truth; form and place of the holes."""
    table = ResultsTable.nested(results, "scenes", keys=(), outer=("kind",))
    found = {}
    for kind in ARRANGEMENTS:
        scenes = table.select(kind=kind).records
        found[f"hole_found_{kind}"] = exact_share(scene["holes"] > 0 for scene in scenes)
        found[f"passage_in_truth_{kind}"] = exact_share(scene["passages"] > 0 for scene in scenes)
    holes = [scene for kind in WITH_HOLE for scene in table.select(kind=kind).records if scene["holes"]]
    found["found_where_the_passage_is"] = exact_share(scene["real"] for scene in holes)
    found["two_contacts_on_either_side"] = exact_share(scene["form"] == [2, 2] for scene in holes)
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """How often each outcome came, by kind and object; and a picture of each kind."""
    outcomes = (
        {"kind": r["kind"], "thing": s.get("thing", ""), "cycles": s.get("loops"), "holes": s["holes"]}
        for r in results
        for s in r["scenes"]
    )
    return tally(outcomes, "scenes") + [example for result in results for example in result["examples"]]
