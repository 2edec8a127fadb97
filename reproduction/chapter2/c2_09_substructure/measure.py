"""Measures, rows and pictures of claim C2.9: in which scenes the skeleton of a stack is found."""

from collections.abc import Mapping, Sequence
from functools import partial

from lifelore.core.metrics import Estimate
from reproduction.chapter2.c2_09_substructure.run import HOSTS, READINGS
from reproduction.chapter2.scenes.scene_example import draw_examples
from reproduction.chapter2.scenes.scene_lots import examples_in
from reproduction.engine.estimates import exact_share
from reproduction.engine.results_table import tally

SEARCHES = {f"in_{host.replace(' ', '_')}": host for host in HOSTS} | {"two_contacts_in_stack": "reversed"}
"""Beginning of the measure's name → key of a search."""
ASKED = {
    "in_two_contacts": ("connected", "things"),
    "in_two_things": ("connected", "things"),
    "in_row": ("connected", "support"),
    "in_two_on_one": ("connected",),
    "two_contacts_in_stack": ("connected", "things"),
}
"""Readings of each search with an interval; the rows count all readings."""
CAPTIONS = {
    "stack": "a stack: its skeleton is part of …",
    "two contacts": "… that of a stack with two contacts",
    "row": "a row: alike but for what carries what",
}
draw = partial(draw_examples, captions=CAPTIONS)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Share of stacks found in each kind of scene, by reading; share of witnesses that are right."""
    drawn = [row for result in results if not result["real"] for row in result["scenes"]]
    found = {
        f"{name}_{reading}": exact_share(row[SEARCHES[name]][reading] for row in drawn)
        for name, readings in ASKED.items()
        for reading in readings
    }
    found["witness_right"] = exact_share(row["witness"] for row in drawn if row["witness"] is not None)
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """How often each set of answers came; and three pictures."""
    answers = (
        {"real": r["real"], "in": search, **{name: row[search][name] for name in READINGS}}
        for r in results
        for row in r["scenes"]
        for search in SEARCHES.values()
        if search in row
    )
    return tally(answers, "scenes") + examples_in(results)
