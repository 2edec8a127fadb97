"""C2.13: a ball on top of an L-block's upright: the block's nodes, and what centres of mass tell (Figure 2.1).

Contact points and centres of mass classify the pair by the pairs of C2.1. Half of the scenes are of a ball on a
post beside the upright: the centres are as far apart, but the ball is not on the block.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain

import numpy as np

from lifelore.core.metrics import Estimate
from reproduction.chapter2.scenes import tabletop_pairs
from reproduction.chapter2.scenes.scene_example import draw_examples
from reproduction.chapter2.scenes.scene_lots import lots
from reproduction.chapter2.scenes.tabletop_pairs import KERNEL_NAMES, STANDARD, Row, data_sets
from reproduction.chapter2.scoring.pair_validation import THRESHOLD, Reading, votes_of_neighbours, votes_on
from reproduction.chapter2.scoring.relation_scoring import CARRIED
from reproduction.engine.estimates import exact_share, mean_or_unmeasured

ON_BLOCK, ON_POST = ARRANGEMENTS = "ball-at-l-block", "ball-on-post"
LOT = 15
NODES = 3
"""Of the L-block in the thesis's figure, without the threshold."""
run_cell, shared, draw = tabletop_pairs.run_cell, tabletop_pairs.SETTINGS_OF_A_CELL, draw_examples


def cells(settings: Mapping) -> list[dict]:
    """Lots of pairs to learn from, the first data set of C2.1; then of scenes, by arrangement."""
    numbers = range(settings["scenes"])
    scenes = [
        {"arrangement": name, "numbers": list(numbers[first : first + LOT])}
        for name in ARRANGEMENTS
        for first in numbers[::LOT]
    ]
    return lots(settings["pairs"], tabletop_pairs.LOT, data_set=0) + scenes


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The measures at the standard kernel."""
    return measures(results, STANDARD)


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The measures for every kernel."""
    for kernel in KERNEL_NAMES:
        yield {"kernel": kernel}, measures(results, kernel)


def measures(results: Sequence[Mapping], kernel: str) -> dict[str, Estimate]:
    """Shares of scenes by the block's nodes, with *on* by contact points, and told right by either method."""
    sets = data_sets(results)
    found = [nodes(row, kernel) for row in sets[ON_BLOCK]]
    told = told_right(sets, kernel)
    return {
        "rank_of_three_nodes": mean_or_unmeasured((len(own) < NODES) + 0.5 * (len(own) == NODES) for own in found),
        "topmost_alone_remains": exact_share(map(topmost_alone_remains, found)),
        "on_by_contacts": exact_share(told["contacts"][ON_BLOCK]),
        **{f"told_by_{name}": exact_share(chain(*own.values())) for name, own in told.items()},
    }


def nodes(row: Row, kernel: str = STANDARD) -> np.ndarray:
    """Height (metres) and support vectors of each of the block's nodes, none dropped, ``(n, 2)``."""
    contacts = row["contacts"].get(kernel, {"b": []})["b"]
    return np.array(contacts, float).reshape(-1, 4)[:, 2:]


def topmost_alone_remains(found: np.ndarray) -> bool:
    """Whether one node has at least `THRESHOLD` support vectors and no other is higher."""
    strong = found[found[:, 1] >= THRESHOLD]
    return len(strong) == 1 and bool(strong[0, 0] >= found[:, 0].max())


def told_right(sets: Mapping, kernel: str) -> dict[str, dict[str, list[bool]]]:
    """By *contacts* and *centres*, and by arrangement: whether *on* is predicted where it holds, not elsewhere."""
    rows = [*sets[0], *sets[ON_BLOCK], *sets[ON_POST]]
    train = np.arange(len(rows)) < len(sets[0])
    centres = np.array([row["centres"] for row in rows])
    votes = {
        "contacts": votes_of_neighbours(rows, Reading(kernel), train),
        "centres": votes_on(centres, np.arange(len(rows)), rows, Reading(), train),
    }
    found: dict[str, dict[str, list[bool]]] = {}
    for name, own in votes.items():
        said = [relation in CARRIED for relation in own.relations(len(rows))[len(sets[0]) :]]
        first = len(sets[ON_BLOCK])
        found[name] = {ON_BLOCK: said[:first], ON_POST: [not on for on in said[first:]]}
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The pictures of a scene."""
    return list(chain(*(result["examples"] for result in results if result["set"] == ON_BLOCK)))
