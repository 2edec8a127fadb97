"""Shapes: their measures, and that the two kits share no kind."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.domains.tabletop import shapes
from lifelore.domains.tabletop.kits import HELD_OUT, TRAINING, kit_named
from lifelore.domains.tabletop.pose import about

SIZES = {
    "box": (shapes.box(0.2, 0.1, 0.05), (0.2, 0.1, 0.05)),
    "cylinder": (shapes.cylinder(0.03, 0.2), (0.06, 0.06, 0.2)),
    "ellipsoid": (shapes.ellipsoid(0.04, 0.03, 0.02), (0.08, 0.06, 0.04)),
    "l_block": (shapes.l_block(0.2, 0.1, 0.15, 0.03, 0.04), (0.2, 0.1, 0.15)),
    "arch": (shapes.arch(0.2, 0.1, 0.15, 0.03, 0.04), (0.2, 0.1, 0.15)),
    "stairs": (shapes.stairs(0.2, 0.1, 0.15, 3), (0.2, 0.1, 0.15)),
    "hinged, straight": (shapes.hinged_blocks(0.1, 0.04, 0.02, 0.0), (0.2, 0.04, 0.02)),
    "wedge": (shapes.wedge(0.1, 0.06, 0.05), (0.1, 0.06, 0.05)),
    "paddle": (shapes.paddle(0.2, 0.1, 0.05, 0.02), (0.2, 0.1, 0.02)),
    "cross": (shapes.cross(0.2, 0.05, 0.04), (0.2, 0.2, 0.04)),
}


@pytest.mark.parametrize(("shape", "size"), SIZES.values(), ids=SIZES)
def test_a_shape_has_the_size_it_was_asked_for(shape, size):
    assert np.ptp(shape.outline(), axis=0) == pytest.approx(size)


def test_a_cup_is_open_inside():
    cup = shapes.cup(0.04, 0.05, 0.1, 0.005, handle=True)
    wall = [part for part in cup.parts if part.kind == shapes.BOX]
    nearest = min(float(np.linalg.norm(part.position[:2])) for part in wall)
    assert nearest == pytest.approx(0.045 - 0.0025)
    floor = cup.parts[0]
    assert floor.position[2] + 0.0025 == pytest.approx(-0.05 + 0.005)


def test_turning_a_shape_turns_its_outline_and_hinge():
    shape = shapes.hinged_blocks(0.1, 0.04, 0.02, 0.5)
    turn = about(2, np.pi / 2)
    turned = shape.turned(turn)
    assert turned.outline() == pytest.approx(shape.outline() @ turn.T)
    assert turned.hinge.axis == pytest.approx((-1, 0, 0))


def test_held_out_scenes_share_no_kind_with_training():
    assert not set(TRAINING.kinds) & set(HELD_OUT.kinds)
    rng = np.random.default_rng(0)
    pieces = [
        {kit.plank(rng).kind, kit.block(0.1, 0.1, 0.1).kind, kit.pillar(rng).kind, kit.ledge(rng).shape.kind,
         kit.vessel(rng).kind, *(kit.filler(rng, 0.04).kind for _ in range(20))} | set(kit.kinds)
        for kit in (TRAINING, HELD_OUT)
    ]  # fmt: skip
    assert not pieces[0] & pieces[1]


def test_an_unknown_kit_is_refused():
    with pytest.raises(InputError, match="training, held-out, all, got 'mine'"):
        kit_named("mine")
