"""C2.6: the hole between two things, found as a cycle of their contact point networks.

An L-block carries one of two hinged blocks, or a different thing, and in both scenes the loop through both
networks and the contact edges between them is found. A cycle alone is also what one long contact leaves that came
out as two contact points, so a loop counts as a hole only if it opens (`perception.holes`); the share of scenes
with any cycle stands beside it. What is true is told by sticks pushed through the true shapes (`passage`). The
things' contacts with the ground take no part. Real scenes carry no truth about holes; how many show one is only
counted. Thesis: §2.4.2, Figure 2.6.
"""

from collections.abc import Mapping, Sequence

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter2.c2_06_same_hole.hole_scenes import ARRANGEMENTS, LOT, run_cell
from lifelore.experiments.chapter2.real_scenes import real_scenes, real_scenes_folder
from lifelore.experiments.chapter2.scene_example import draw_examples
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.estimates import exact_share, mean_or_unmeasured
from lifelore.experiments.engine.predicate import Predicate

WITH_HOLE = ("hinged", "other")
FULL = {"scenes": 150, "real": True}
QUICK = {"scenes": 2, "real": False}


def _check(settings: Mapping) -> None:
    if settings["scenes"] < 1:
        raise InputError(f"scenes must be at least 1, got {settings['scenes']}")


def cells(settings: Mapping) -> list[dict]:
    """Scenes in lots, by kind; then the real scenes, where asked for and there."""
    lots = [{"kind": kind, "first": k} for kind in ARRANGEMENTS for k in range(0, settings["scenes"], LOT)]
    if not settings["real"] or real_scenes_folder() is None:
        return lots
    return lots + [{"kind": "real", "scene": scene.name} for scene in real_scenes()]


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


def _draw(result: Mapping):
    return draw_examples(result, columns=3)


CLAIM = Claim(
    id="C2.6",
    title="The same hole between an L-block and two different things (Figure 2.6)",
    thesis="An L-block carries two hinged blocks, or a toy goat: in both scenes the networks and the contacts "
    "between them close to the same topological hole.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C2.6"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes={
        "found between hinged blocks": "a contact is hidden from the camera",
        "found between other things": "a contact is hidden from the camera",
        "none at a contact split in two": "the missing points look like an opening",
        "none in a corner": "the hidden faces of a block in a corner look like an opening",
    },
    check=_check,
)
