"""Measures, rows and pictures of claim C2.6: scenes with a hole, by kind, and the form and place of the holes."""

from collections.abc import Mapping, Sequence

from lifelore.core.metrics import Estimate
from reproduction.chapter2.c2_06_same_hole.run import ARRANGEMENTS
from reproduction.chapter2.scenes.scene_example import draw_examples
from reproduction.chapter2.scenes.scene_lots import tally_and_examples
from reproduction.engine.estimates import exact_share
from reproduction.engine.results_table import ResultsTable

WITH_HOLE = ("hinged", "other")
draw = draw_examples


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

    def outcome(result: Mapping, scene: Mapping) -> dict:
        found = {"kind": result["kind"], "thing": scene.get("thing", ""), "cycles": scene.get("loops")}
        return found | {"holes": scene["holes"]}

    return tally_and_examples(results, "scenes", outcome)
