"""Kits of shapes to draw from: kinds by weight, and the pieces that templates build with.

`TRAINING` and `HELD_OUT` share no kind of shape, so a model trained with the one is tested on the other.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from lifelore.core.errors import InputError
from lifelore.domains.tabletop import shapes
from lifelore.domains.tabletop.shapes import Shape

Draw = Callable[[np.random.Generator], Shape]


@dataclass(frozen=True)
class Ledge:
    """A shape with a flat foot at `height`, from x = `inner`, where its upright begins, to x = `outer`."""

    shape: Shape
    height: float
    inner: float
    outer: float
    width: float


@dataclass(frozen=True)
class Kit:
    """What a scene is made of.

    `kinds` gives each kind's draw and weight. `plank` draws something long and flat along x, `block` makes
    something of a size with a flat face at −x, `pillar` draws something of a flat top and bottom, `ledge` a step
    to stand objects on, `vessel` something open, and `filler` what goes into a vessel of a radius.
    """

    kinds: Mapping[str, tuple[Draw, float]]
    plank: Draw
    block: Callable[[float, float, float], Shape]
    pillar: Draw
    ledge: Callable[[np.random.Generator], Ledge]
    vessel: Draw
    filler: Callable[[np.random.Generator, float], Shape]

    def draw(self, rng: np.random.Generator) -> Shape:
        """A shape about its middle, kinds by weight, density 0.7 to 1.3 of its kind's."""
        weights = np.array([weight for _, weight in self.kinds.values()])
        name = list(self.kinds)[int(rng.choice(len(weights), p=weights / weights.sum()))]
        shape = self.kinds[name][0](rng).centred()
        return replace(shape, density=shape.density * rng.uniform(0.7, 1.3))


def _carton(rng: np.random.Generator) -> Shape:
    length = rng.uniform(0.15, 0.29)
    return shapes.box(length, length * rng.uniform(0.6, 0.8), rng.uniform(0.035, 0.08), "carton")


def _slab(rng: np.random.Generator) -> Shape:
    return shapes.box(*rng.uniform((0.15, 0.05, 0.012), (0.29, 0.2, 0.045)), kind="slab")


def _bowl(rng: np.random.Generator) -> Shape:
    low, wall = rng.uniform(0.03, 0.05), rng.uniform(0.004, 0.006)
    return shapes.cup(low, low * rng.uniform(1.4, 1.8), rng.uniform(0.045, 0.08), wall, False, "bowl")


def _mug(rng: np.random.Generator) -> Shape:
    low, wall = rng.uniform(0.03, 0.042), rng.uniform(0.004, 0.006)
    return shapes.cup(low, low * rng.uniform(1.0, 1.2), rng.uniform(0.08, 0.11), wall, True)


def _l_block(rng: np.random.Generator) -> Shape:
    length, width, height = rng.uniform((0.1, 0.05, 0.08), (0.2, 0.12, 0.2))
    return shapes.l_block(
        length, width, height, rng.uniform(0.025, 0.4 * height), rng.uniform(0.025, 0.4 * length)
    )


def _arch(rng: np.random.Generator) -> Shape:
    length, width, height = rng.uniform((0.14, 0.05, 0.06), (0.24, 0.1, 0.12))
    return shapes.arch(length, width, height, rng.uniform(0.02, 0.25 * length), rng.uniform(0.02, 0.5 * height))


def _hinged(rng: np.random.Generator) -> Shape:
    length, width, height = rng.uniform((0.07, 0.03, 0.02), (0.12, 0.05, 0.035))
    return shapes.hinged_blocks(length, width, height, rng.uniform(-0.6, 0.6))


def _torus(rng: np.random.Generator) -> Shape:
    tube = rng.uniform(0.012, 0.025)
    return shapes.torus(tube + rng.uniform(0.02, 0.06), tube)


def _stone(rng: np.random.Generator) -> Shape:
    directions = rng.normal(size=(24, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    radii = rng.uniform((0.03, 0.03, 0.02), (0.09, 0.07, 0.05))
    return shapes.stone(directions * rng.uniform(0.8, 1.0, (24, 1)) * radii)


def _cone(rng: np.random.Generator) -> Shape:
    low, high = rng.uniform((0.04, 0.02), (0.07, 0.04))
    return shapes.cone(low, high, rng.uniform(0.08, 0.2))


def _paddle(rng: np.random.Generator) -> Shape:
    broad = rng.uniform(0.06, 0.16)
    return shapes.paddle(rng.uniform(0.15, 0.28), broad, broad * rng.uniform(0.3, 0.8), rng.uniform(0.015, 0.045))


def _box_in(rng: np.random.Generator, radius: float) -> Shape:
    length, width, height = rng.uniform(0.5, 1.2, 3) * radius
    return shapes.box(length, width, 2.5 * height)


def _ellipsoid_in(rng: np.random.Generator, radius: float) -> Shape:
    a, b, c = rng.uniform(0.5, 0.9, 3) * radius
    return shapes.ellipsoid(a, b, c)


def _l_ledge(rng: np.random.Generator) -> Ledge:
    length, width, height = rng.uniform((0.12, 0.06, 0.1), (0.22, 0.12, 0.2))
    foot, back = rng.uniform(0.025, 0.05, 2)
    block = shapes.l_block(length, width, height, foot, back)
    return Ledge(block, float(foot), float(back - length / 2), float(length / 2), float(width))


def _stairs_ledge(rng: np.random.Generator) -> Ledge:
    length, width, height = rng.uniform((0.16, 0.06, 0.1), (0.26, 0.12, 0.16))
    block = shapes.stairs(length, width, height, 2)
    return Ledge(block, float(height / 2), 0.0, float(length / 2), float(width))


TRAINING = Kit(
    {
        "box": (lambda rng: shapes.box(*rng.uniform((0.06, 0.04, 0.03), (0.22, 0.15, 0.12))), 4),
        "carton": (_carton, 6),
        "slab": (_slab, 3),
        "cylinder": (lambda rng: shapes.cylinder(rng.uniform(0.025, 0.055), rng.uniform(0.06, 0.25)), 4),
        "ball": (lambda rng: shapes.ball(rng.uniform(0.025, 0.07)), 1),
        "bowl": (_bowl, 1.5),
        "l_block": (_l_block, 1.5),
        "wedge": (lambda rng: shapes.wedge(*rng.uniform((0.08, 0.06, 0.04), (0.2, 0.12, 0.1))), 1),
        "stone": (_stone, 1),
    },
    plank=_slab,
    block=shapes.box,
    pillar=lambda rng: shapes.box(*rng.uniform((0.04, 0.05, 0.04), (0.08, 0.12, 0.15))),
    ledge=_l_ledge,
    vessel=_bowl,
    filler=lambda rng, radius: (
        shapes.ball(rng.uniform(0.5, 1.1) * radius) if rng.random() < 0.5 else _box_in(rng, radius)
    ),
)
"""Kinds to train on: what the real scenes of boxes, cans and bowls are made of, and some more."""

HELD_OUT = Kit(
    {
        "mug": (_mug, 2),
        "torus": (_torus, 1),
        "ellipsoid": (lambda rng: shapes.ellipsoid(*rng.uniform((0.04, 0.03, 0.025), (0.09, 0.07, 0.05))), 1),
        "prism": (
            lambda rng: shapes.prism(int(rng.integers(5, 9)), rng.uniform(0.03, 0.07), rng.uniform(0.04, 0.2)), 3
        ),
        "arch": (_arch, 1.5),
        "hinged_blocks": (_hinged, 1),
        "cone": (_cone, 1.5),
        "cross": (lambda rng: shapes.cross(*rng.uniform((0.12, 0.03, 0.04), (0.22, 0.07, 0.1))), 1.5),
        "paddle": (_paddle, 3),
    },
    plank=_paddle,
    block=lambda length, width, height: shapes.paddle(length, width, 0.7 * width, height),
    pillar=lambda rng: shapes.prism(6, rng.uniform(0.025, 0.045), rng.uniform(0.04, 0.15)),
    ledge=_stairs_ledge,
    vessel=_mug,
    filler=lambda rng, radius: _ellipsoid_in(rng, radius),
)  # fmt: skip
"""Kinds that no training scene holds."""

ALL = replace(TRAINING, kinds={**TRAINING.kinds, **HELD_OUT.kinds})
KITS = {"training": TRAINING, "held-out": HELD_OUT, "all": ALL}


def kit_named(name: str) -> Kit:
    """The kit of a name.

    Raises
    ------
    InputError
        No kit has this name.
    """
    if name not in KITS:
        raise InputError(f"shapes must be one of {', '.join(KITS)}, got '{name}'")
    return KITS[name]
