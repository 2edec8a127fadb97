"""Passages through shapes whose holes are known."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.domains.tabletop.pose import Pose
from lifelore.domains.tabletop.shapes import arch, box, cylinder
from reproduction.chapter2.c2_06_same_hole.passage import GRID, MARGIN, passages

STILL = Pose(np.zeros(3), np.eye(3))


def on_a_slab(shape, height):
    """A slab whose top is at z = 0 and the shape standing on it."""
    return [box(0.3, 0.1, 0.02), shape], [
        Pose(np.array([0, 0, -0.01]), np.eye(3)),
        Pose(np.array([0, 0, height / 2]), np.eye(3)),
    ]


def test_an_arch_on_a_slab_has_one_passage_of_its_own_size():
    # Legs 20 mm of 120, plate 30 mm of 80: the opening is 80 × 50 mm, less the stick's margin all around.
    ways = passages(*on_a_slab(arch(0.12, 0.06, 0.08, 0.02, 0.03), 0.08), (0, 1, 0))
    assert len(ways) == 1
    expected = (0.08 - 2 * MARGIN) * (0.05 - 2 * MARGIN)
    assert len(ways[0]) * GRID**2 == pytest.approx(expected, rel=0.15)
    assert np.abs(ways[0][:, 0]).max() < 0.04
    assert 0 < ways[0][:, 2].min() < ways[0][:, 2].max() < 0.05


def test_across_the_arch_there_is_none():
    assert passages(*on_a_slab(arch(0.12, 0.06, 0.08, 0.02, 0.03), 0.08), (1, 0, 0)) == []


def test_a_block_on_a_slab_has_none():
    assert passages(*on_a_slab(box(0.12, 0.06, 0.08), 0.08), (0, 1, 0)) == []


def test_other_shapes_are_refused():
    with pytest.raises(InputError, match="boxes and balls"):
        passages([cylinder(0.02, 0.1)], [STILL], (0, 1, 0))
