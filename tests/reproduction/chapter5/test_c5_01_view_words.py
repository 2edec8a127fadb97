"""Words of space on boxes made by hand, seen from the four sides; in and between on walls and rows."""

import numpy as np
import pytest

from lifelore.core.relations import PairLabel
from reproduction.chapter5.c5_01_more_relations.view_words import (
    is_between,
    is_in,
    shared_outline,
    words,
    words_of_pair,
)

SOUTH, NORTH = np.array([0.0, -1, 0.5]), np.array([0.0, 1, 0.5])
EAST, WEST = np.array([1.0, 0, 0.5]), np.array([-1.0, 0, 0.5])


def block(x: float, y: float, z: float = 0.0, size=(0.06, 0.06, 0.1)) -> np.ndarray:
    """Corners of a box over (x, y), its foot at z."""
    corners = np.array([*np.ndindex(2, 2, 2)]) - [0.5, 0.5, 0]
    return corners * size + [x, y, z]


def carried(thing: np.ndarray, *way: float) -> np.ndarray:
    return thing + np.array(way)


LEFT, RIGHT = block(-0.05, 0), block(0.05, 0)


@pytest.mark.parametrize(
    ("camera", "word"), [(SOUTH, "right_of"), (NORTH, "left_of"), (EAST, "in_front_of"), (WEST, "behind")]
)
def test_the_eastern_block_as_each_side_sees_it(camera, word):
    assert words(RIGHT, LEFT, camera) == [word]
    opposite = {"right_of": "left_of", "behind": "in_front_of"}
    opposite |= {after: before for before, after in opposite.items()}
    assert words(LEFT, RIGHT, camera) == [opposite[word]]


def test_sectors_of_sixty_degrees_overlap():
    def seen_at(degrees: float) -> list[str]:
        way = 0.1 * np.array([np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))])
        # The camera due south of the middle between the two, so that away is north.
        camera = np.array([way[0] / 2, -5.0, 1])
        return words(block(*way), block(0, 0), camera)

    assert seen_at(25) == ["right_of"]
    assert seen_at(45) == ["right_of", "behind"]
    assert seen_at(65) == ["behind"]
    assert seen_at(-45) == ["right_of", "in_front_of"]
    assert seen_at(135) == ["left_of", "behind"]
    assert seen_at(-155) == ["left_of"]


def test_under_needs_a_quarter_of_the_smaller_outline():
    lower = block(0, 0)
    assert words(lower, block(0, 0, 0.1), SOUTH) == ["under"]
    assert words(block(0, 0, 0.1), lower, SOUTH) == []
    # Half and a sixth of the smaller outline, of boxes 60 mm wide.
    assert shared_outline(lower, block(0.03, 0, 0.1)) == pytest.approx(0.5, abs=0.02)
    assert words(lower, block(0.03, 0, 0.1), NORTH) == ["under"]
    assert words(lower, block(0.05, 0, 0.1), NORTH) == []
    # The smaller's outline counts: a small thing on a large one shares all of its own.
    assert shared_outline(lower, block(0.01, 0.01, 0.1, size=(0.02, 0.02, 0.02))) == 1.0
    assert shared_outline(lower, block(1, 0)) == 0.0


def test_the_users_word():
    high, low = block(0.05, 0, size=(0.06, 0.06, 0.2)), block(-0.05, 0)
    assert words(high, low, SOUTH) == ["right_of", "dwarfs"]
    assert words(low, high, SOUTH) == ["left_of"]
    assert words(block(0.05, 0, size=(0.06, 0.06, 0.19)), low, SOUTH) == ["right_of"]
    # Not of what it stands on or hangs over.
    assert words(block(0, 0, 0.1, size=(0.06, 0.06, 0.4)), carried(low, 0.05, 0, 0), SOUTH) == []


def test_a_pair_in_both_orders_and_in_none():
    assert words_of_pair(7, 4, RIGHT, LEFT, SOUTH) == [PairLabel(7, 4, "right_of"), PairLabel(4, 7, "left_of")]
    upper = block(0, 0, 0.1)
    assert words_of_pair(2, 3, upper, block(0, 0), SOUTH) == [PairLabel(3, 2, "under")]
    assert words_of_pair(2, 3, upper, block(0.09, 0), SOUTH) == [PairLabel(2, 3, "none")]


@pytest.mark.parametrize(
    ("a", "c", "between"),
    [
        (carried(LEFT, -0.05, 0, 0), carried(RIGHT, 0.05, 0, 0), True),
        # At a right angle, at 125°, and at 115°; in all three the way crosses b.
        (carried(LEFT, -0.05, 0, 0), block(0, 0.1), False),
        (block(-0.1, 0), block(0.1 * np.cos(np.deg2rad(55)), 0.1 * np.sin(np.deg2rad(55))), True),
        (block(-0.1, 0), block(0.1 * np.cos(np.deg2rad(65)), 0.1 * np.sin(np.deg2rad(65))), False),
        # On the same side; above it.
        (carried(RIGHT, 0.05, 0, 0), carried(RIGHT, 0.15, 0, 0), False),
        (carried(LEFT, -0.05, 0, 0), block(0, 0, 0.1), False),
        (carried(LEFT, -0.05, 0, 0), block(0.1, 0, 0.1), False),
    ],
)
def test_between(a, c, between):
    b = block(0, 0, size=(0.1, 0.1, 0.1))
    assert is_between(b, a, c) is between
    assert is_between(b, c, a) is between


def test_between_wants_the_way_to_cross_the_one_between():
    # Seen from b the two are 132° apart, 2 atan(0.09 / 0.04), but the way passes 40 mm by; b is 30 mm wide there.
    assert not is_between(block(0, 0), block(-0.09, 0.04), block(0.09, 0.04))
    assert is_between(block(0, 0, size=(0.06, 0.09, 0.1)), block(-0.09, 0.04), block(0.09, 0.04))


FLOOR = block(0, 0, size=(0.2, 0.2, 0.01))
WALLS = [
    block(0.095, 0, size=(0.01, 0.2, 0.1)),
    block(-0.095, 0, size=(0.01, 0.2, 0.1)),
    block(0, 0.095, size=(0.2, 0.01, 0.1)),
    block(0, -0.095, size=(0.2, 0.01, 0.1)),
]
INNER = block(0, 0, 0.01, size=(0.04, 0.04, 0.05))


@pytest.mark.parametrize(
    ("thing", "parts", "inside"),
    [
        (INNER, [FLOOR, *WALLS], True),
        # A drawer pulled open: of 24 directions only the 5 within 30° of its opening are free, 19 / 24 ≥ 3/4.
        (INNER, [FLOOR, *WALLS[1:]], True),
        # Two opposite walls: 10 directions are free. A corner of two: 10 as well. A floor alone: all.
        (INNER, [FLOOR, *WALLS[2:]], False),
        (INNER, [FLOOR, WALLS[0], WALLS[2]], False),
        (INNER, [FLOOR], False),
        # Half way up to the lower top: a tall thing within low walls is in, one on top of them is not.
        (block(0, 0, 0.01, size=(0.04, 0.04, 0.5)), [FLOOR, *WALLS], True),
        (carried(INNER, 0, 0, 0.1), [FLOOR, *WALLS], False),
        # A lid that sank a little into the rim; a thing that reaches 10 mm into it, and one that reaches less.
        (block(0, 0, 0.0995, size=(0.2, 0.2, 0.02)), [FLOOR, *WALLS], False),
        (block(0, 0, 0.089, size=(0.04, 0.04, 0.05)), [FLOOR, *WALLS], True),
        (block(0, 0, 0.092, size=(0.04, 0.04, 0.05)), [FLOOR, *WALLS], False),
        # What stands around the walls has its middle among them and is not in them.
        (block(0, 0, 0.0, size=(0.3, 0.3, 0.08)), [FLOOR, *WALLS], False),
        # Beside the walls, and where the material itself is.
        (carried(INNER, 0.3, 0, 0), [FLOOR, *WALLS], False),
        (np.concatenate([FLOOR, *WALLS]), [INNER], False),
    ],
)
def test_in(thing, parts, inside):
    assert is_in(thing, parts) is inside
