"""C2.9: the skeleton of three things on one another is a subgraph of that of a stack with two contacts.

Every drawn stack is looked for in a stack whose top, an arch, touches the thing below it twice; and in controls:
two things, and the reverse, the stack with two contacts in the plain stack. The skeleton of a row of three
neighbours is that of a stack, as it is without predicates, so the rows are asked for the skeleton of what carries
what. Two readings of subgraph stand beside each other: the thesis's, with every edge of a network, and one that
asks only that points of one thing stay in one thing (*connected*, errata E15). Thesis: §2.5, Figure 2.10.
"""

from collections.abc import Mapping, Sequence

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter2.c2_09_substructure.skeleton_pairs import HOSTS, READINGS, pair_cells, run_cell
from lifelore.experiments.chapter2.scene_example import draw_examples
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.estimates import exact_share, mean_or_unmeasured
from lifelore.experiments.engine.predicate import Predicate

FULL = {"scenes": 120, "real": True}
QUICK = {"scenes": 2, "real": False}
CAPTIONS = {
    "stack": "a stack: its skeleton is part of …",
    "two contacts": "… that of a stack with two contacts",
    "row": "a row: alike but for what carries what",
}
SEARCHES = (*HOSTS, "reversed")


def _check(settings: Mapping) -> None:
    if settings["scenes"] < 1:
        raise InputError(f"scenes must be at least 1, got {settings['scenes']}")


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


def _draw(result: Mapping):
    return draw_examples(result, columns=3, captions=CAPTIONS)


CLAIM = Claim(
    id="C2.9",
    title="A stack's skeleton within that of a stack with two contacts (Figure 2.10)",
    thesis="Three objects on one another, and the same with two contacts between the topmost and the one below: "
    "the first skeleton is a subgraph of the second.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C2.9"),
    cells=pair_cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes={
        "a subgraph": "a contact that came out as two points in the stack is one in the other scene",
        "the witness is right": "without up and down a skeleton may fit another way round",
    },
    check=_check,
)
