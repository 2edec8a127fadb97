"""Arrangements: ways to place the objects of a scene.

*mixed*: groups side by side; *pair*: two objects in a wanted relation; *varied*: any arrangement but *pair*. The
module `piles` has those of books, boxes and cartons.
"""

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.relations import ADJACENT, ADJACENT_GAP, BOTH, ON
from lifelore.domains.tabletop.groups import Template, bridge, heap, lean, nested, single, stacked, step, tower
from lifelore.domains.tabletop.kits import Kit
from lifelore.domains.tabletop.layout import Group, put_beside, separation
from lifelore.domains.tabletop.piles import PILES, Place
from lifelore.domains.tabletop.settings import TabletopSettings

MIXED: dict[Template, float] = {
    single: 0.34, stacked: 0.2, tower: 0.09, lean: 0.18, bridge: 0.05, step: 0.06, nested: 0.03, heap: 0.05
}  # fmt: skip
"""Templates of a scene of many objects, and how often each is drawn."""
GAPS = {
    (0.0005, 0.003): 0.22, (0.003, 0.02): 0.25, (0.02, 0.035): 0.3, (0.035, 0.085): 0.13, (0.085, 0.14): 0.1
}  # fmt: skip
"""Metres between neighbours, and how often: touching, near, where *adjacent* ends, further, unlabelled."""


def place_mixed(rng: np.random.Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """Groups of objects, each set down beside an earlier one at a drawn gap."""
    n_objects = int(rng.integers(settings.n_objects[0], settings.n_objects[1] + 1))
    weights = np.array(list(MIXED.values()))
    scene: list[tuple[float, Group]] = []
    count = 0
    while count < n_objects:
        group = list(MIXED)[int(rng.choice(len(MIXED), p=weights / weights.sum()))](rng, kit)
        if count + len(group) <= n_objects:
            scene.append(_set_down(rng, scene, group, _drawn_gap(rng)))
            count += len(group)
    return [item for _, group in scene for item in group]


def _drawn_gap(rng: np.random.Generator) -> float:
    """Metres between neighbours."""
    chances = np.array(list(GAPS.values()))
    return float(rng.uniform(*list(GAPS)[int(rng.choice(len(GAPS), p=chances / chances.sum()))]))


def _set_down(
    rng: np.random.Generator, scene: list[tuple[float, Group]], group: Group, gap: float
) -> tuple[float, Group]:
    """The group turned and moved beside an earlier one, and its yaw; the first stays in the middle."""
    if not scene:
        yaw = float(rng.uniform(0, 2 * np.pi))
        return yaw, [item.turned(yaw) for item in group]
    best, best_room = (0.0, group), -np.inf
    for _ in range(8):
        beside, near = scene[int(rng.integers(len(scene)))]
        if rng.random() < 0.5:
            yaw, direction = beside + rng.normal(0, 0.04), beside + np.pi / 2 * rng.integers(4)
        else:
            yaw, direction = rng.uniform(0, 2 * np.pi, 2)
        placed = put_beside(near, [item.turned(float(yaw)) for item in group], float(direction), gap)
        room = min(separation(other, placed) for _, other in scene)
        if room > best_room:
            best, best_room = (float(yaw), placed), room
        if room > min(gap, 0.002) - 0.0005:
            break
    return best


def place_pair(rng: np.random.Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """Two objects that may stand in the `wanted` relation."""
    if wanted in (ON, BOTH):
        template = (stacked, nested)[rng.random() < 0.05] if wanted == ON else (lean, step)[rng.random() < 0.25]
        return [item.turned(float(rng.uniform(0, 2 * np.pi))) for item in template(rng, kit)]
    edge = ADJACENT_GAP
    low, high = (0.0005, edge) if wanted == ADJACENT else (edge, edge + 0.0125 if rng.random() < 0.4 else 0.075)
    first = _set_down(rng, [], single(rng, kit), 0.0)
    return [*first[1], *_set_down(rng, [first], single(rng, kit), float(rng.uniform(low, high)))[1]]


VARIED = {"mixed": 0.55, "pile": 0.18, "ramp": 0.09, "books": 0.07, "cartons": 0.11}
"""How often a scene of `place_varied` is of each arrangement."""


def place_varied(rng: np.random.Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """A scene of a drawn arrangement: *mixed*, or one of books, boxes and cartons."""
    name = list(VARIED)[int(rng.choice(len(VARIED), p=list(VARIED.values())))]
    return PILES.get(name, place_mixed)(rng, kit, settings, wanted)


ARRANGEMENTS: dict[str, Place] = {"mixed": place_mixed, "pair": place_pair, "varied": place_varied, **PILES}
"""How objects are placed, by the arrangement's name."""


def arrangement_named(name: str) -> Place:
    """The arrangement of a name.

    Raises
    ------
    InputError
        None has it.
    """
    if name not in ARRANGEMENTS:
        raise InputError(f"arrangement must be one of {', '.join(ARRANGEMENTS)}, got '{name}'")
    return ARRANGEMENTS[name]
