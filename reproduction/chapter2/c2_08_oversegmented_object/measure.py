"""Measures and rows of claim C2.8: relations of the parts of an object that was cut, by kind of cut."""

from collections.abc import Mapping, Sequence

from lifelore.core.metrics import Estimate
from reproduction.chapter2.c2_08_oversegmented_object.run import TRUE
from reproduction.chapter2.scenes.scene_lots import tally_and_examples
from reproduction.chapter2.scoring.relation_scoring import share_over_scenes
from reproduction.engine.estimates import exact_share
from reproduction.engine.results_table import ResultsTable

SETS = {"simulated": False, "real": True}
TABLE_TRUE = {"level": ["none", "on"], "upright": ["on", "on"]}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Recall of either relation, and relations of the parts with the table, by set of scenes."""
    table, found = ResultsTable.nested(results, "rows", keys=("kind",), outer=("real",)), {}
    for name, real in SETS.items():
        judged = [row for row in table.select(real=real).records if row["kind"] in TRUE]
        for kind, true in TRUE.items():
            own = [row for row in judged if row["kind"] == kind]
            right = [row["said"] == true for row in own]
            # Each simulated cut of a kind is of a scene of its own; real scenes have several.
            found[f"{true}_right_{name}"] = share_by_scene(own, right) if real else exact_share(right)
        right = [row["table"] == TABLE_TRUE[row["kind"]] for row in judged]
        found[f"table_right_{name}"] = share_by_scene(judged, right)
    return found


def share_by_scene(rows: Sequence[Mapping], answers: Sequence[bool]) -> Estimate:
    """Share of true answers, scenes resampled; with the exact interval where all answers agree."""
    totals: dict[str, list[int]] = {}
    for row, answer in zip(rows, answers, strict=True):
        right, asked = totals.get(row["scene"], (0, 0))
        totals[row["scene"]] = [right + answer, asked + 1]
    right, asked = zip(*totals.values(), strict=True) if totals else ((), ())
    return share_over_scenes(right, asked, lambda *_: exact_share(answers).ci95 or (0.0, 1.0))


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """How often each relation came, by set of scenes and kind of cut (oblique in steps of 15°); and pictures."""

    def outcome(result: Mapping, row: Mapping) -> dict:
        low = 15 * min(int(row["tilt"] // 15), 5)
        cut = row["kind"] if row["kind"] in TRUE else f"{low}° to {low + 15}°"
        name = "real" if result["real"] else "simulated"
        return {"set": name, "cut": cut, "said": row["said"], "boxes": row["boxes"]}

    return tally_and_examples(results, "rows", outcome, "cuts")
