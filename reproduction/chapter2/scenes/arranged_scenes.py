"""Scenes in the thesis's arrangements, drawn by the tabletop, and arrangements of our own: controls to them.

Controls: three blocks in a *row*, two blocks side by side on one (*two on one*), a block in the *corner* of an
L-block, which touches it below and beside without leaving a hole, and a *ball on a post* beside an L-block's
upright, as far from the block's centre of mass as a ball on the upright is.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.relations import ADJACENT, BOTH, ON
from lifelore.core.streams import stream
from lifelore.domains.tabletop.layout import Group, put_beside, stand, top
from lifelore.domains.tabletop.pose import about
from lifelore.domains.tabletop.shapes import ball, box, l_block
from lifelore.domains.tabletop.tabletop import (
    ATTEMPTS,
    TabletopScene,
    TabletopSettings,
    sample_scene,
    settle_scene,
)
from reproduction.chapter2.scenes.figure_scenes import FIGURES, facing, figure_scene

USUAL = TabletopSettings()


@dataclass(frozen=True)
class Placement:
    """A way to place objects, and the labels that must hold when they have settled: (a, b, relation) from 2."""

    place: Callable[[np.random.Generator], Group]
    true: frozenset[tuple[int, int, str]] = frozenset()


def arranged(name: str, seed: int, number: int, settings: TabletopSettings = USUAL) -> TabletopScene:
    """Scene `number` of an arrangement: of `CONTROLS`, of `FIGURES`, or of the tabletop. Needs MuJoCo."""
    if name in CONTROLS:
        return settled(CONTROLS[name], name, seed, number, settings)
    own_seed = int(stream(seed, "arranged", name).integers(2**31))
    if name in FIGURES:
        return figure_scene(name, own_seed, number, settings)
    return sample_scene(own_seed, number, replace(settings, arrangement=name))


def settled(
    placement: Placement, name: str, seed: int, number: int, settings: TabletopSettings = USUAL
) -> TabletopScene:
    """Scene `number` of a placement: drawn until a scene settles, is visible, and has the labels that must hold.

    Raises `InputError` where no scene does in `ATTEMPTS` draws.
    """
    for attempt in range(ATTEMPTS):
        rng = stream(seed, "arranged", name, number, attempt)
        scene = settle_scene(placement.place(rng), rng, settings)
        if scene is not None:
            labels = {(label.a, label.b, label.relation) for label in scene.truth}
            labels |= {(b, a, relation) for a, b, relation in labels if relation == ADJACENT}
            if placement.true <= labels:
                return replace(scene, name=f"{name}{number:05d}", attempts=attempt + 1)
    raise InputError(f"no '{name}' settles as it must in {ATTEMPTS} draws with {settings}; use other settings")


def turned(rng: np.random.Generator, group: Group) -> Group:
    """The group turned by any yaw."""
    yaw = float(rng.uniform(0, 2 * np.pi))
    return [placed.turned(yaw) for placed in group]


def place_row(rng: np.random.Generator) -> Group:
    """Three blocks side by side, as large as those of a stack, their gaps within that of *adjacent*."""
    group: Group = []
    for _ in range(3):
        block = [stand(box(*rng.uniform((0.07, 0.06, 0.04), (0.14, 0.12, 0.1))), about(2, rng.normal(0, 0.1)))]
        group += put_beside(group[-1:], block, 0.0, float(rng.uniform(0.0005, 0.012))) if group else block
    return turned(rng, group)


def place_two_on_one(rng: np.random.Generator) -> Group:
    """Two blocks on a slab, too far apart to be neighbours."""
    slab = [stand(box(*rng.uniform((0.26, 0.1, 0.03), (0.32, 0.16, 0.06))))]
    blocks = []
    for side in (-1, 1):
        block = stand(box(*rng.uniform((0.05, 0.05, 0.04), (0.07, 0.09, 0.1))), height=top(slab))
        blocks.append(block.moved(side * float(rng.uniform(0.085, 0.095)), 0.0))
    return turned(rng, [*slab, *blocks])


def place_corner(rng: np.random.Generator) -> Group:
    """A block on the foot of an L-block and against its upright: two sides touch and nothing passes between."""
    length, width, height = rng.uniform((0.18, 0.07, 0.1), (0.24, 0.11, 0.16))
    foot, back = rng.uniform(0.025, 0.04, 2)
    size = rng.uniform((0.06, 0.05, 0.05), (0.8 * (length - back), width, 0.9 * (height - foot)))
    at = back - length / 2 + size[0] / 2 + float(rng.uniform(0.0003, 0.002))
    ell = stand(l_block(length, width, height, foot, back))
    block = stand(box(*size), height=foot).moved(at, 0.0)
    return facing(rng, [ell, block])


def place_ball_on_post(rng: np.random.Generator) -> Group:
    """A ball on a post on an L-block's foot, not touching the block: the reverse of a ball on the upright.

    From the block's centre of mass to the ball's leads the same displacement as for a ball on the upright of the
    same block, turned half round. The objects are block, ball and post.
    """
    size = 0.024
    while True:
        length, width, height = rng.uniform((0.12, 0.05, 0.12), (0.2, 0.09, 0.2))
        back, foot = float(rng.uniform(0.03, 0.05)), float(rng.uniform(0.025, 0.05))
        upright = (back - length) / 2
        volumes = length * foot, back * (height - foot)
        at = 2 * upright * volumes[1] / sum(volumes) - upright
        if at - size / 2 > back - length / 2 + 0.005 and at + size / 2 < length / 2:
            break
    post = stand(box(size, size, float(height) - foot), height=foot).moved(at, 0.0)
    guest = stand(ball(float(rng.uniform(0.02, 0.035))), height=top([post])).moved(at, 0.0)
    ell = stand(l_block(float(length), float(width), float(height), foot, back))
    return facing(rng, [ell, guest, post])


CONTROLS = {
    "row": Placement(place_row, frozenset({(2, 3, ADJACENT), (3, 4, ADJACENT)})),
    "two-on-one": Placement(place_two_on_one, frozenset({(3, 2, ON), (4, 2, ON)})),
    "corner": Placement(place_corner, frozenset({(3, 2, BOTH)})),
    "ball-on-post": Placement(place_ball_on_post, frozenset({(3, 4, ON), (4, 2, ON)})),
}
"""Arrangements of this module, by name."""
