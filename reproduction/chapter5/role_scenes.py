"""Scenes of flat pieces whose roles follow from the placement and from the settled physics (claims C5.2, C5.8).

All objects are of the same range of sizes, whatever their role, so shape does not reveal the role; two pools have
no kind of shape in common. Ten roles: *alone*; *base*, *middle* and *top* of a stack; *span* and *pillar* of a
bridge; *leaner* and *leant on*; *neighbour*; *between* two neighbours.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT, BOTH, NONE, ON
from lifelore.domains.tabletop.layout import Group, Placed, put_beside, stand, top
from lifelore.domains.tabletop.pose import about
from lifelore.domains.tabletop.settings import TabletopScene
from lifelore.domains.tabletop.shapes import Shape, box, cross, cylinder, paddle, prism
from reproduction.chapter2.scenes.arranged_scenes import Placement, settled, turned

Draw = Callable[[np.random.Generator], Shape]


def _paddle(rng: np.random.Generator) -> Shape:
    broad = rng.uniform(0.07, 0.1)
    return paddle(rng.uniform(0.12, 0.18), broad, 0.7 * broad, rng.uniform(0.03, 0.05))


POOLS: dict[str, tuple[Draw, ...]] = {
    "first": (
        lambda rng: box(*rng.uniform((0.12, 0.06, 0.03), (0.18, 0.09, 0.05))),
        lambda rng: cross(*rng.uniform((0.12, 0.05, 0.03), (0.16, 0.08, 0.05))),
    ),
    "second": (
        _paddle,
        lambda rng: prism(int(rng.integers(5, 9)), rng.uniform(0.06, 0.08), rng.uniform(0.03, 0.05)),
        lambda rng: cylinder(rng.uniform(0.055, 0.075), rng.uniform(0.03, 0.05)),
    ),
}
"""Flat pieces: bars and crosses; paddles, plates of five to eight sides, and discs."""


@dataclass(frozen=True)
class Part:
    """A kind of scene: roles of its objects in the order of labels, from 2; placement; labels that must hold."""

    roles: tuple[str, ...]
    place: Callable[[np.random.Generator, Draw], Group]
    true: frozenset[tuple[int, int, str]]


def _piece(rng: np.random.Generator, draw: Draw, height: float = 0.0) -> Placed:
    return stand(draw(rng).centred(), about(2, rng.normal(0, 0.15)), height)


def place_tower(n: int, rng: np.random.Generator, draw: Draw) -> Group:
    """`n` pieces on one another, nearly over one another."""
    group: Group = []
    for _ in range(n):
        x, y = rng.uniform(-0.015, 0.015, 2)
        group.append(_piece(rng, draw, top(group) if group else 0.0).moved(float(x), float(y)))
    return turned(rng, group)


def place_bridge(rng: np.random.Generator, draw: Draw) -> Group:
    """A piece across two of one height, a finger or two apart."""
    pillar = draw(rng).centred()
    pillars = [stand(pillar, about(2, np.pi / 2))]
    pillars += put_beside(pillars, [stand(pillar, about(2, np.pi / 2))], 0.0, float(rng.uniform(0.025, 0.04)))
    middle = float(np.mean([placed.pose.position[0] for placed in pillars]))
    return turned(rng, [*pillars, stand(draw(rng).centred(), height=top(pillars)).moved(middle, 0.0)])


def place_leaner(rng: np.random.Generator, draw: Draw) -> Group:
    """A piece put slantwise over the edge of another, its foot on the table."""
    support, slope = _piece(rng, draw), rng.uniform(0.4, 0.7)
    outline, slanted = support.outline(), stand(draw(rng).centred(), about(1, slope))
    points = slanted.outline()
    edge = outline[np.abs(outline[:, 1]) < 0.03][:, 0].max() if (np.abs(outline[:, 1]) < 0.03).any() else 0.05
    foot = edge + outline[:, 2].max() / np.tan(slope)
    return turned(rng, [support, slanted.moved(float(foot - points[points[:, 2].argmin(), 0] + 0.002), 0.0)])


def place_neighbours(n: int, rng: np.random.Generator, draw: Draw) -> Group:
    """`n` pieces side by side in a row."""
    group: Group = [_piece(rng, draw)]
    for _ in range(n - 1):
        group += put_beside(group[-1:], [_piece(rng, draw)], 0.0, float(rng.uniform(0.0005, 0.012)))
    return turned(rng, group)


def _part(roles: str, place: Callable[[np.random.Generator, Draw], Group], *true: tuple[int, int, str]) -> Part:
    return Part(tuple(roles.split(", ")), place, frozenset(true))


PARTS = {
    "alone": _part("alone", partial(place_tower, 1), (2, TABLE, ON)),
    "two": _part("base, top", partial(place_tower, 2), (3, 2, ON), (3, TABLE, NONE)),
    "tower": _part("base, middle, top", partial(place_tower, 3), (3, 2, ON), (4, 3, ON), (4, TABLE, NONE)),
    "bridge": _part("pillar, pillar, span", place_bridge, (4, 2, ON), (4, 3, ON), (4, TABLE, NONE)),
    "lean": _part("leant on, leaner", place_leaner, (3, 2, BOTH), (2, TABLE, ON), (3, TABLE, ON)),
    "neighbours": _part(
        "neighbour, neighbour", partial(place_neighbours, 2), (2, 3, ADJACENT), (2, TABLE, ON), (3, TABLE, ON)
    ),
    "row": _part(
        "neighbour, between, neighbour", partial(place_neighbours, 3),
        (2, 3, ADJACENT), (3, 4, ADJACENT), (2, TABLE, ON), (3, TABLE, ON), (4, TABLE, ON),
    ),
}  # fmt: skip


def role_scene(part: str, pool: str, name: str, seed: int, number: int) -> TabletopScene:
    """Scene `number` of a part with the shapes of a pool, settled; `name` names its random stream."""
    draws = POOLS[pool]

    def any_shape(rng: np.random.Generator) -> Shape:
        return draws[int(rng.integers(len(draws)))](rng)

    placement = Placement(lambda rng: PARTS[part].place(rng, any_shape), PARTS[part].true)
    return settled(placement, name, seed, number)
