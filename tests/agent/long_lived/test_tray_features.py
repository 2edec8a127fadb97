"""Features of trays by hand: boxes as points, what they carry, and where fingers find room."""

import numpy as np
import pytest

from lifelore.agent.long_lived.families.finger_room import CLEARANCE, grasp_of, reach_into
from lifelore.agent.long_lived.families.tray_features import FINGERS, NEAR, PerceivedTray

THIN, WIDE = FINGERS


def box(middle, size, bottom=0.0):
    """Points on the top and the sides of a box, 2 mm apart; `middle` (x, y), `size` (x, y, z), metres."""
    x, y, z = (np.arange(0, extent + 1e-9, 0.002) for extent in size)
    top = np.stack(np.meshgrid(x, y, [size[2]]), axis=-1).reshape(-1, 3)
    sides = np.concatenate(
        [np.stack(np.meshgrid(x, [0, size[1]], z), axis=-1), np.stack(np.meshgrid([0, size[0]], y, z), axis=-1)],
        axis=None,
    ).reshape(-1, 3)
    corner = np.array([middle[0] - size[0] / 2, middle[1] - size[1] / 2, bottom])
    return np.concatenate([top, sides]) + corner


def tray(*boxes, carries=None):
    return PerceivedTray(0, dict(enumerate(boxes)), carries or {})


TARGET = box((0.0, 0.0), (0.04, 0.10, 0.05))
"""Narrow in x: the fingers stand at x = ±2 cm and beyond."""


def beside(gap, along="x"):
    """A neighbour with a gap to the target, on the fingers' side or on the other."""
    middle = (0.02 + gap + 0.02, 0.0) if along == "x" else (0.0, 0.05 + gap + 0.02)
    return box(middle, (0.04, 0.04, 0.05))


def test_fingers_go_to_the_narrowest_side():
    grasp = grasp_of(TARGET, 0.0)
    assert abs(grasp.along[0]) == pytest.approx(1)
    assert grasp.ends == pytest.approx((-0.02, 0.02), abs=0.002)
    assert grasp.middle == pytest.approx(0, abs=0.002)
    assert grasp.tip == pytest.approx(0.01)  # 1 cm above the table; 6 cm below the top would be lower
    high = grasp_of(box((0, 0), (0.04, 0.04, 0.2)), 0.0)
    assert high.tip == pytest.approx(0.14)


@pytest.mark.parametrize("thickness", FINGERS)
@pytest.mark.parametrize("gap", [0.0, 0.006, 0.02, 0.05])
def test_how_far_a_neighbour_reaches_into_a_finger(thickness, gap):
    """The finger fills the gap from `CLEARANCE` to `CLEARANCE` and its thickness."""
    found = reach_into(grasp_of(TARGET, 0.0), beside(gap), (thickness,))[0]
    # A wall nearer than the finger's middle is met beyond the middle: the finger's radius is the most.
    assert found == pytest.approx(min(CLEARANCE + thickness - gap, thickness / 2), abs=0.0015)


def test_a_neighbour_below_the_tips_is_not_in_the_way():
    low = box((0.045, 0.0), (0.04, 0.04, 0.008))
    assert reach_into(grasp_of(TARGET, 0.0), low, (THIN,))[0] == -np.inf


def test_room_depends_on_the_side_and_the_finger():
    assert tray(TARGET, beside(0.002)).room(0, {0, 1}) == 2
    assert tray(TARGET, beside(0.020)).room(0, {0, 1}) == 1
    assert tray(TARGET, beside(0.040)).room(0, {0, 1}) == 0
    touching = tray(TARGET, beside(0.002, "y"))
    assert touching.room(0, {0, 1}) == 0  # it touches, but not where the fingers go


def test_room_comes_back_when_the_neighbour_is_gone():
    crowded = tray(TARGET, beside(0.002))
    assert crowded.room(0, {0}) == 0
    assert crowded.hinders(1, 0, {0, 1})
    assert not tray(TARGET, beside(0.07)).hinders(1, 0, {0, 1})


@pytest.mark.parametrize(("probability", "load"), [(0.0, 0), (0.05, 1), (0.3, 2), (0.9, 3)])
def test_the_load_is_a_class_of_its_probability(probability, load):
    loaded = tray(TARGET, box((0, 0), (0.02, 0.02, 0.02), 0.05), carries={(1, 0): probability})
    assert loaded.load(0, {0, 1}) == load
    assert loaded.load(0, {0}) == 0
    assert loaded.load(1, {0, 1}) == 0


def test_two_doubtful_loads_are_one_probable_load():
    doubtful = tray(TARGET, TARGET, TARGET, carries={(1, 0): 0.4, (2, 0): 0.4})
    assert doubtful.load(0, {0, 1, 2}) == 3  # 1 - 0.6 * 0.6
    assert doubtful.load(0, {0, 1}) == 2


def test_a_stack_is_taken_from_its_top():
    stack = tray(
        TARGET,
        box((0, 0), (0.03, 0.03, 0.03), 0.05),
        box((0, 0), (0.02, 0.02, 0.02), 0.08),
        beside(0.03),
        carries={(1, 0): 0.9, (2, 1): 0.9},
    )
    here = frozenset(range(4))
    assert stack.pile(0, here) == {1, 2}
    assert stack.top(here) == 2
    assert stack.top(here - {2}) == 1
    assert stack.top(frozenset({0, 3})) is None
    assert stack.neighbours(here) == [3]
    assert stack.rests_on(2, here) == [1]


def test_the_neighbour_in_the_way_comes_before_the_nearest():
    crowded = tray(TARGET, beside(0.001, "y"), beside(0.015))
    assert crowded.neighbours(frozenset({0, 1, 2})) == [2, 1]
    far = tray(TARGET, beside(NEAR + 0.01))
    assert far.neighbours(frozenset({0, 1})) == []


def test_slim_objects_may_tip():
    both = tray(box((0, 0), (0.04, 0.04, 0.1)), TARGET)
    assert both.tall(0)
    assert not both.tall(1)
    # What rests on another object is as high as what is seen of it.
    raised = tray(TARGET, box((0, 0), (0.04, 0.04, 0.04), 0.05), carries={(1, 0): 0.9})
    assert not raised.tall(1)


def test_without_relations_all_objects_are_free():
    blind = PerceivedTray(0, {0: np.zeros((1, 3)), 1: np.full((1, 3), 0.01)}, {}, related=False)
    assert (blind.load(0, {0, 1}), blind.room(0, {0, 1}), blind.tall(0)) == (0, 0, False)
    assert blind.neighbours(frozenset({0, 1})) == [1]
