"""Scenes of the thesis's figures: a ball at an L-block (2.1) or on a block (2.2), holes (2.6), stacks (2.7, 2.10).

The label 2 is the lowest object, 3 the one on it, and so on. A figure says how the objects are placed, and what
must be true of them when they have settled.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from lifelore.core.errors import InputError
from lifelore.core.relations import CORE_RELATIONS
from lifelore.core.streams import stream
from lifelore.domains.tabletop.layout import Group, stand, top
from lifelore.domains.tabletop.photograph import FIRST_OBJECT
from lifelore.domains.tabletop.physics import Contacts
from lifelore.domains.tabletop.pose import Pose, about
from lifelore.domains.tabletop.shapes import BALL, BOX, Shape, arch, ball, box, hinged_blocks, l_block, part
from lifelore.domains.tabletop.tabletop import ATTEMPTS, TabletopScene, TabletopSettings, settle_scene


@dataclass(frozen=True)
class Figure:
    """How objects are placed, and the pairs (a, b) of labels that must settle so that a is carried by b alone.

    `regions` is how many separate regions the first such pair must touch in.
    """

    place: Callable[[np.random.Generator], Group]
    on: tuple[tuple[int, int], ...]
    regions: int = 0

    def shows(self, share: NDArray[np.float64], contacts: Contacts, poses: Sequence[Pose]) -> bool:
        """Whether the objects that must be carried are, and touch in as many regions as they must."""
        table = len(share) - 1
        for a, b in self.on:
            if share[a - FIRST_OBJECT, b - FIRST_OBJECT] < 0.5 or share[a - FIRST_OBJECT, table] > 0:
                return False
        if not self.regions:
            return True
        low, high = sorted(label - FIRST_OBJECT for label in self.on[0])
        pressed = (
            (np.linalg.norm(contacts.forces, axis=1) > 0)
            & (np.minimum(contacts.first, contacts.second) == low)
            & (np.maximum(contacts.first, contacts.second) == high)
        )
        # Looked at along the lowest object's y axis, contacts along an edge across it are one region.
        return contact_regions(contacts.positions[pressed] @ poses[0].rotation[:, [0, 2]]) == self.regions


def figure_scene(name: str, seed: int, number: int, settings: TabletopSettings) -> TabletopScene:
    """Scene `number` of a figure: drawn until one settles, shows the figure and can be seen. Needs MuJoCo."""
    figure = FIGURES[name]
    for attempt in range(ATTEMPTS):
        rng = stream(seed, "tabletop", name, number, attempt)
        rng.integers(len(CORE_RELATIONS))  # the relation that other arrangements aim at
        scene = settle_scene(figure.place(rng), rng, settings, figure.shows)
        if scene is not None:
            return replace(scene, name=f"sim{number:05d}", attempts=attempt + 1)
    raise InputError(f"no '{name}' settles as it must in {ATTEMPTS} draws with {settings}; use other settings")


def contact_regions(places: NDArray[np.float64]) -> int:
    """How many regions contacts at `places` ``(k, d)`` form: those closer than 25 mm belong together."""
    if not len(places):
        return 0
    close = np.linalg.norm(places[:, None] - places[None], axis=2) < 0.025
    return int(connected_components(close, directed=False)[0])


def animal(length: float, width: float, height: float, leg: float) -> Shape:
    """A toy on four legs, each `leg` thick and half of `height` long."""
    legs = [
        part(BOX, (leg / 2, leg / 2, height / 4), (s * (length - leg) / 2, t * (width - leg) / 2, -height / 4))
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    trunk = part(BOX, (length / 2, width / 2, height / 8), (0, 0, height / 8))
    head = part(BALL, (0.3 * width,), (length / 2, 0, 0.35 * height))
    return Shape("animal", (trunk, head, *legs))


def facing(rng: np.random.Generator, group: Group) -> Group:
    """Turned so that what is open along y can be looked into."""
    yaw = float(rng.normal(0, 0.3) + np.pi * rng.integers(2))
    return [item.turned(yaw) for item in group]


def place_hole_hinged(rng: np.random.Generator) -> Group:
    """Two hinged blocks as a tent on the foot of an L-block, or bent from the top of its upright to its foot."""
    block, width, thick = rng.uniform(0.09, 0.12), rng.uniform(0.03, 0.05), rng.uniform(0.018, 0.026)
    foot, back = rng.uniform(0.025, 0.04, 2)
    if rng.random() < 0.5:
        slope = rng.uniform(0.8, 1.05)
        length = back + 2 * block * np.cos(slope) + rng.uniform(0.03, 0.05)
        ell = l_block(length, width * 1.5, rng.uniform(0.08, 0.14), foot, back)
        tent = hinged_blocks(block, width, thick, 2 * slope, about(1, -slope))
        return facing(rng, [stand(ell), stand(tent, height=foot).moved(float(back / 2), 0.0)])
    slope = rng.uniform(0.6, 1.0)
    height = foot + block * np.sin(slope) - thick / 2
    length = back / 2 + block * (0.5 + np.cos(slope)) + rng.uniform(0.03, 0.05)
    ell, bent = l_block(length, width * 1.5, height, foot, back), hinged_blocks(block, width, thick, slope)
    low = bent.outline()[:, 0].min()
    placed = stand(bent)
    shift = -length / 2 + back / 2 - block / 2 - (low + placed.pose.position[0])
    rise = foot + 0.003 - placed.outline()[:, 2].min()
    return facing(rng, [stand(ell), placed.moved(float(shift), 0.0, float(rise))])


def place_hole_other(rng: np.random.Generator) -> Group:
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
        return facing(rng, [stand(ell), stand(guest, height=foot).moved(float(back / 2 + 0.01), 0.0)])
    rise, reach = height - foot, rng.uniform(0.5, 0.85) * run
    slope = np.arctan2(rise, reach)
    plank = stand(box(np.hypot(rise, reach) * 1.15, 0.7 * width, rng.uniform(0.012, 0.02)), about(1, slope), foot)
    points = plank.outline()
    shift = back - length / 2 + reach + 0.003 - points[points[:, 2].argmin(), 0]
    return facing(rng, [stand(ell), plank.moved(float(shift), 0.0)])


def place_no_hole(rng: np.random.Generator) -> Group:
    """A block whose whole face lies on a slab."""
    length, width = rng.uniform((0.16, 0.09), (0.26, 0.15))
    slab, block = (
        box(length, width, rng.uniform(0.02, 0.05)),
        box(0.75 * length, 0.75 * width, rng.uniform(0.04, 0.12)),
    )
    below = stand(slab)
    return facing(rng, [below, stand(block, height=top([below]))])


def _stack(rng: np.random.Generator, middle_height: float) -> Group:
    """Two boxes, the upper a little smaller."""
    length, width = rng.uniform((0.15, 0.1), (0.24, 0.16))
    group = [stand(box(length, width, rng.uniform(0.04, 0.1)))]
    upper = box(0.85 * length, 0.85 * width, middle_height)
    return [*group, stand(upper, about(2, rng.normal(0, 0.15)), top(group))]


def place_stack(rng: np.random.Generator) -> Group:
    """Three boxes on one another (Fig. 2.7)."""
    group = _stack(rng, rng.uniform(0.04, 0.1))
    size = rng.uniform((0.07, 0.05, 0.04), (0.12, 0.09, 0.1))
    return facing(rng, [*group, stand(box(*size), about(2, rng.uniform(0, 6)), top(group))])


def place_stack_two_contacts(rng: np.random.Generator) -> Group:
    """Two boxes and an arch, which touches the upper at both its feet (Fig. 2.10)."""
    group = _stack(rng, rng.uniform(0.04, 0.08))
    length, width, height = rng.uniform((0.11, 0.05, 0.06), (0.125, 0.08, 0.1))
    guest = arch(length, width, height, rng.uniform(0.014, 0.022), 0.35 * height)
    return facing(rng, [*group, stand(guest, about(2, rng.normal(0, 0.1)), top(group))])


def place_ball_on_block(rng: np.random.Generator) -> Group:
    """A ball on a block (Fig. 2.2)."""
    block = stand(box(*rng.uniform((0.1, 0.08, 0.05), (0.2, 0.15, 0.15))))
    return facing(rng, [block, stand(ball(rng.uniform(0.02, 0.05)), height=top([block]))])


def place_ball_at_l_block(rng: np.random.Generator) -> Group:
    """A ball on top of an L-block's upright, far from the block's middle (Fig. 2.1)."""
    length, width, height = rng.uniform((0.12, 0.05, 0.12), (0.2, 0.09, 0.2))
    back = rng.uniform(0.03, 0.05)
    ell = stand(l_block(length, width, height, rng.uniform(0.025, 0.05), back))
    guest = stand(ball(rng.uniform(0.02, 0.035)), height=height)
    return facing(rng, [ell, guest.moved(float((back - length) / 2), 0.0)])


FIGURES = {
    "hole-hinged": Figure(place_hole_hinged, ((3, 2),), regions=2),
    "hole-other": Figure(place_hole_other, ((3, 2),), regions=2),
    "no-hole": Figure(place_no_hole, ((3, 2),)),
    "stack": Figure(place_stack, ((4, 3), (3, 2))),
    "stack-two-contacts": Figure(place_stack_two_contacts, ((4, 3), (3, 2)), regions=2),
    "ball-on-block": Figure(place_ball_on_block, ((3, 2),)),
    "ball-at-l-block": Figure(place_ball_at_l_block, ((3, 2),)),
}
"""The figures by name."""
