"""Templates: small groups of objects placed so that, settled, they often stand in a certain relation.

What a group turns into is for physics to say: of the objects dropped on another about four in five stay there.
"""

from collections.abc import Callable

import numpy as np

from lifelore.domains.tabletop.kits import Kit
from lifelore.domains.tabletop.layout import Group, middle, rest, stand, top
from lifelore.domains.tabletop.pose import about, random_rotation
from lifelore.domains.tabletop.shapes import Shape

Template = Callable[[np.random.Generator, Kit], Group]


def single(rng: np.random.Generator, kit: Kit) -> Group:
    """One object on the table."""
    shape = kit.draw(rng)
    return [stand(shape, rest(rng, shape))]


def stacked(rng: np.random.Generator, kit: Kit) -> Group:
    """An object dropped on another."""
    return _on_top(rng, kit, single(rng, kit))


def tower(rng: np.random.Generator, kit: Kit) -> Group:
    """Three objects on one another."""
    return _on_top(rng, kit, stacked(rng, kit))


def _on_top(rng: np.random.Generator, kit: Kit, group: Group) -> Group:
    """One more object dropped on a group's last, in four of five cases off its middle."""
    shape = kit.draw(rng)
    half = np.ptp(group[-1].outline(), axis=0)[:2] / 2
    x, y = middle(group[-1:]) + rng.uniform(-0.7, 0.7, 2) * half * (rng.random() < 0.8)
    return [*group, stand(shape, rest(rng, shape), top(group[-1:])).moved(x, y)]


def lean(rng: np.random.Generator, kit: Kit) -> Group:
    """A long object put slantwise against another, its foot on the table."""
    support = single(rng, kit)[0]
    outline = support.outline()
    angle = rng.uniform(np.radians(12), np.radians(75))
    slanted = stand(_leaner(rng, kit), about(2, rng.normal(0, 0.12)) @ about(1, angle))
    edge, height, points = outline[:, 0].max(), outline[:, 2].max(), slanted.outline()
    if height < points[:, 2].max() - 0.01:
        # Its underside rises from the foot at `angle` and is to pass over the support's upper edge.
        shift = edge + height / np.tan(angle) - points[points[:, 2].argmin(), 0]
    else:
        shift = edge - points[:, 0].min()
    aside = rng.uniform(-0.4, 0.4) * np.ptp(outline[:, 1])
    return [support, slanted.moved(float(shift) + 0.002, float(aside))]


def _leaner(rng: np.random.Generator, kit: Kit) -> Shape:
    """Something with a long axis along x: a drawn shape if it has one, else a plank."""
    shape = kit.draw(rng)
    size = np.ptp(shape.outline(), axis=0)
    if shape.kind in ("bowl", "ball", "stone", "torus", "mug", "ellipsoid") or size.max() < 0.1:
        return kit.plank(rng)
    return shape.turned((np.eye(3), about(2, np.pi / 2), about(1, np.pi / 2))[int(size.argmax())])


def bridge(rng: np.random.Generator, kit: Kit) -> Group:
    """A plank across two blocks of one height."""
    pillar, plank = kit.pillar(rng), kit.plank(rng)
    foot = float(np.ptp(pillar.outline()[:, 0]))
    apart = max(rng.uniform(0.7, 0.95) * (np.ptp(plank.outline()[:, 0]) - foot) / 2, foot / 2 + 0.005)
    legs = [stand(pillar).moved(side * apart, 0.0) for side in (-1, 1)]
    return [*legs, stand(plank, about(2, rng.normal(0, 0.08)), top(legs))]


def step(rng: np.random.Generator, kit: Kit) -> Group:
    """A block on the foot of a ledge, against its upright or a little off."""
    ledge = kit.ledge(rng)
    size = rng.uniform((0.3, 0.5, 0.02), (1.0, 1.2, 0.16)) * [ledge.outer - ledge.inner, ledge.width, 1]
    gap = rng.choice([0.0005, rng.uniform(0, 0.006), rng.uniform(0.01, 0.03)], p=[0.5, 0.3, 0.2])
    block = stand(kit.block(*map(float, size)), height=ledge.height).moved(
        float(ledge.inner + size[0] / 2 + gap), 0.0
    )
    return [stand(ledge.shape), block]


def nested(rng: np.random.Generator, kit: Kit) -> Group:
    """A vessel with another of its kind in it, or something smaller."""
    vessel = kit.vessel(rng).centred()
    outer = stand(vessel)
    radius = float(np.ptp(vessel.outline()[:, 1])) / 3
    inner = vessel if rng.random() < 0.4 else kit.filler(rng, radius)
    return [outer, stand(inner, about(2, rng.uniform(0, 6)), top([outer]))]


def heap(rng: np.random.Generator, kit: Kit) -> Group:
    """Two or three objects, the later dropped any way round over the first."""
    group = single(rng, kit)
    for _ in range(int(rng.integers(1, 3))):
        x, y = rng.uniform(-0.06, 0.06, 2)
        group.append(stand(kit.draw(rng), random_rotation(rng), top(group)).moved(x, y))
    return group
