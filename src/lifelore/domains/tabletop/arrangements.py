"""Arrangements: what a scene is to show, as a way to place objects and a test that, settled, they show it.

*mixed*: groups side by side; *pair*: two objects in a wanted relation; the others are of the thesis's figures: a
ball at an L-block (2.1), a ball on a block (2.2), holes (2.6) and their control, and stacks (2.7, 2.10). `piles`
has those of books, boxes and cartons. In figures, label 2 is the lowest object, 3 the one on it, and so on.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.relations import ADJACENT, ADJACENT_GAP, BOTH, ON
from lifelore.domains.tabletop.groups import Template, bridge, heap, lean, nested, single, stacked, step, tower
from lifelore.domains.tabletop.kits import Kit
from lifelore.domains.tabletop.layout import Group, put_beside, separation, stand, top
from lifelore.domains.tabletop.piles import PILES
from lifelore.domains.tabletop.pose import about
from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.domains.tabletop.shapes import animal, arch, ball, box, hinged_blocks, l_block


@dataclass(frozen=True)
class Arrangement:
    """How objects are placed, and the pairs (a, b) of labels that must settle so that a is carried by b.

    `regions` is how many separate regions the first such pair must touch in; `shuffled` whether the labels are
    dealt at random, so that their order tells nothing.
    """

    place: Callable[[np.random.Generator, Kit, TabletopSettings, str], Group]
    on: tuple[tuple[int, int], ...] = ()
    regions: int = 0
    shuffled: bool = False


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


# --- the thesis's figures -------------------------------------------------------------------------------------


def _facing(rng: np.random.Generator, group: Group) -> Group:
    """Turned so that what is open along y can be looked into."""
    yaw = float(rng.normal(0, 0.3) + np.pi * rng.integers(2))
    return [item.turned(yaw) for item in group]


def place_hole_hinged(rng: np.random.Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """Two hinged blocks as a tent on the foot of an L-block, or bent from the top of its upright to its foot."""
    block, width, thick = rng.uniform(0.09, 0.12), rng.uniform(0.03, 0.05), rng.uniform(0.018, 0.026)
    foot, back = rng.uniform(0.025, 0.04, 2)
    if rng.random() < 0.5:
        slope = rng.uniform(0.8, 1.05)
        length = back + 2 * block * np.cos(slope) + rng.uniform(0.03, 0.05)
        ell = l_block(length, width * 1.5, rng.uniform(0.08, 0.14), foot, back)
        tent = hinged_blocks(block, width, thick, 2 * slope, about(1, -slope))
        return _facing(rng, [stand(ell), stand(tent, height=foot).moved(float(back / 2), 0.0)])
    slope = rng.uniform(0.6, 1.0)
    height = foot + block * np.sin(slope) - thick / 2
    length = back / 2 + block * (0.5 + np.cos(slope)) + rng.uniform(0.03, 0.05)
    ell, bent = l_block(length, width * 1.5, height, foot, back), hinged_blocks(block, width, thick, slope)
    low = bent.outline()[:, 0].min()
    placed = stand(bent)
    shift = -length / 2 + back / 2 - block / 2 - (low + placed.pose.position[0])
    rise = foot + 0.003 - placed.outline()[:, 2].min()
    return _facing(rng, [stand(ell), placed.moved(float(shift), 0.0, float(rise))])


def place_hole_other(rng: np.random.Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """A toy on legs or an arch on the foot of an L-block, or a plank from the top of its upright to its foot."""
    length, width, height = rng.uniform((0.18, 0.07, 0.1), (0.24, 0.11, 0.16))
    foot, back = rng.uniform(0.025, 0.04, 2)
    ell, run = l_block(length, width, height, foot, back), length - back
    kind = int(rng.integers(3))
    if kind < 2:
        long, broad, high = rng.uniform(0.65, 0.9) * run, rng.uniform(0.6, 0.9) * width, rng.uniform(0.08, 0.12)
        leg = rng.uniform(0.014, 0.02)
        guest = animal(long, broad, high, leg) if kind else arch(long, broad, high, 1.3 * leg, 0.3 * high)
        # The toy's head may look out over the foot's end, never into the upright.
        return _facing(rng, [stand(ell), stand(guest, height=foot).moved(float(back / 2 + 0.01), 0.0)])
    rise, reach = height - foot, rng.uniform(0.5, 0.85) * run
    slope = np.arctan2(rise, reach)
    plank = stand(box(np.hypot(rise, reach) * 1.15, 0.7 * width, rng.uniform(0.012, 0.02)), about(1, slope), foot)
    points = plank.outline()
    shift = back - length / 2 + reach + 0.003 - points[points[:, 2].argmin(), 0]
    return _facing(rng, [stand(ell), plank.moved(float(shift), 0.0)])


def place_hole(rng: np.random.Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """Either kind of hole."""
    place = place_hole_hinged if rng.random() < 0.5 else place_hole_other
    return place(rng, kit, settings, wanted)


def place_no_hole(rng: np.random.Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """A block whose whole face lies on a slab."""
    length, width = rng.uniform((0.16, 0.09), (0.26, 0.15))
    slab, block = (
        box(length, width, rng.uniform(0.02, 0.05)),
        box(0.75 * length, 0.75 * width, rng.uniform(0.04, 0.12)),
    )
    below = stand(slab)
    return _facing(rng, [below, stand(block, height=top([below]))])


def _stack(rng: np.random.Generator, middle_height: float) -> Group:
    """Two boxes, the upper a little smaller."""
    length, width = rng.uniform((0.15, 0.1), (0.24, 0.16))
    group = [stand(box(length, width, rng.uniform(0.04, 0.1)))]
    upper = box(0.85 * length, 0.85 * width, middle_height)
    return [*group, stand(upper, about(2, rng.normal(0, 0.15)), top(group))]


def place_stack(rng: np.random.Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """Three boxes on one another (Fig. 2.7)."""
    group = _stack(rng, rng.uniform(0.04, 0.1))
    size = rng.uniform((0.07, 0.05, 0.04), (0.12, 0.09, 0.1))
    return _facing(rng, [*group, stand(box(*size), about(2, rng.uniform(0, 6)), top(group))])


def place_stack_two_contacts(rng: np.random.Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """Two boxes and an arch, which touches the upper at both its feet (Fig. 2.10)."""
    group = _stack(rng, rng.uniform(0.04, 0.08))
    length, width, height = rng.uniform((0.11, 0.05, 0.06), (0.125, 0.08, 0.1))
    guest = arch(length, width, height, rng.uniform(0.014, 0.022), 0.35 * height)
    return _facing(rng, [*group, stand(guest, about(2, rng.normal(0, 0.1)), top(group))])


def place_ball_on_block(rng: np.random.Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """A ball on a block (Fig. 2.2)."""
    block = stand(box(*rng.uniform((0.1, 0.08, 0.05), (0.2, 0.15, 0.15))))
    return _facing(rng, [block, stand(ball(rng.uniform(0.02, 0.05)), height=top([block]))])


def place_ball_at_l_block(rng: np.random.Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """A ball on top of an L-block's upright, far from the block's middle (Fig. 2.1)."""
    length, width, height = rng.uniform((0.12, 0.05, 0.12), (0.2, 0.09, 0.2))
    back = rng.uniform(0.03, 0.05)
    ell = stand(l_block(length, width, height, rng.uniform(0.025, 0.05), back))
    guest = stand(ball(rng.uniform(0.02, 0.035)), height=height)
    return _facing(rng, [ell, guest.moved(float((back - length) / 2), 0.0)])


VARIED = {"mixed": 0.55, "pile": 0.18, "ramp": 0.09, "books": 0.07, "cartons": 0.11}
"""How often a scene of `place_varied` is of each arrangement."""


def place_varied(rng: np.random.Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """A scene of a drawn arrangement: *mixed*, or one of books, boxes and cartons."""
    name = list(VARIED)[int(rng.choice(len(VARIED), p=list(VARIED.values())))]
    return PILES.get(name, place_mixed)(rng, kit, settings, wanted)


ARRANGEMENTS: dict[str, Arrangement] = {
    "mixed": Arrangement(place_mixed, shuffled=True),
    "pair": Arrangement(place_pair, shuffled=True),
    "hole": Arrangement(place_hole, ((3, 2),), regions=2),
    "hole-hinged": Arrangement(place_hole_hinged, ((3, 2),), regions=2),
    "hole-other": Arrangement(place_hole_other, ((3, 2),), regions=2),
    "no-hole": Arrangement(place_no_hole, ((3, 2),)),
    "stack": Arrangement(place_stack, ((4, 3), (3, 2))),
    "stack-two-contacts": Arrangement(place_stack_two_contacts, ((4, 3), (3, 2)), regions=2),
    "ball-on-block": Arrangement(place_ball_on_block, ((3, 2),)),
    "ball-at-l-block": Arrangement(place_ball_at_l_block, ((3, 2),)),
    "varied": Arrangement(place_varied, shuffled=True),
    **{name: Arrangement(place, shuffled=True) for name, place in PILES.items()},
}


def arrangement_named(name: str) -> Arrangement:
    """The arrangement of a name.

    Raises
    ------
    InputError
        None has it.
    """
    if name not in ARRANGEMENTS:
        raise InputError(f"arrangement must be one of {', '.join(ARRANGEMENTS)}, got '{name}'")
    return ARRANGEMENTS[name]
