"""Skills on trays set by hand: what is reached, spilled and knocked follows from the physics."""

import numpy as np
import pytest

from lifelore.domains.tabletop.layout import stand
from lifelore.domains.tabletop.pose import about
from lifelore.domains.tabletop.shapes import box
from lifelore.domains.tabletop_job.job import (
    HAND_OVER_BRISKLY,
    HAND_OVER_GENTLY,
    PICK,
    PUSH_APART,
    PUT_ASIDE,
    TabletopJob,
)
from lifelore.domains.tabletop_job.job_types import job_type_named
from lifelore.domains.tabletop_job.skills import PUSH_DISTANCE
from lifelore.domains.tabletop_job.tray import tray_of

pytest.importorskip("mujoco", reason="needs the extra sim")
pytestmark = pytest.mark.sim

BLOCK = box(0.1, 0.1, 0.06)
SMALL = box(0.06, 0.06, 0.05)


def stack():
    return [stand(BLOCK), stand(SMALL, height=0.06)]


def beside(gap):
    return [stand(BLOCK), stand(SMALL).moved(0.08 + gap, 0.0)]


def job(placed, target, name="patient/firm"):
    return TabletopJob(tray_of(placed, target), job_type_named(name))


def do(task, verb, number):
    return task.step(verb * task.n_objects + number)[0].last


def test_the_bottom_of_a_stack_spills_its_top():
    task = job(stack(), 0)
    events = do(task, PICK, 0)
    assert events.reached
    assert events.spilled == (1,)


def test_the_bottom_is_free_once_its_top_is_put_aside():
    task = job(stack(), 0)
    do(task, PICK, 1)
    aside = do(task, PUT_ASIDE, 1)
    assert (aside.put_aside, aside.spilled) == (1, ())
    place = task.poses[1].position
    assert place[2] == pytest.approx(0.025, abs=2e-3)
    assert np.hypot(*place[:2]) > 0.1
    assert do(task, PICK, 0).spilled == ()


def test_the_pillar_of_a_bridge_is_out_of_reach():
    pillars = [stand(box(0.04, 0.05, 0.08)).moved(side * 0.1, 0.0) for side in (-1, 1)]
    task = job([*pillars, stand(box(0.26, 0.06, 0.02), height=0.08)], 0)
    events = do(task, PICK, 0)
    assert not events.reached
    assert (events.spilled, task.observation.held) == ((), None)


def test_a_leaning_plank_falls_when_its_support_is_picked():
    slope = np.radians(40)
    plank = stand(box(0.25, 0.05, 0.015), about(1, slope))
    foot = plank.outline()[plank.outline()[:, 2].argmin(), 0]
    support = stand(box(0.05, 0.15, 0.1))
    task = job([support, plank.moved(float(0.025 + 0.1 / np.tan(slope) - foot) + 0.002, 0.0)], 0)
    assert do(task, PICK, 0).spilled == (1,)


# The fingers of the firm gripper need 4 + 8 mm beside an object, those of the wide gripper 4 + 30 mm.
@pytest.mark.parametrize(
    ("gap", "gripper", "reached"),
    [(0.008, "firm", False), (0.02, "firm", True), (0.02, "wide", False), (0.045, "wide", True)],
)
def test_a_neighbour_nearer_than_a_finger_is_in_the_way(gap, gripper, reached):
    task = job(beside(gap), 1, f"patient/{gripper}")
    events = do(task, PICK, 1)
    assert events.reached == reached
    assert (task.observation.held == 1) == reached


def test_pushing_apart_makes_room():
    task = job(beside(0.008), 1)
    events = do(task, PUSH_APART, 1)
    assert (events.spilled, events.knocked) == ((), ())
    assert task.poses[1].position[0] == pytest.approx(0.088 + PUSH_DISTANCE, abs=0.01)
    assert do(task, PICK, 1).reached


def test_a_weak_gripper_pushes_and_lifts_light_objects_alone():
    heavy = box(0.16, 0.12, 0.12)  # 9 N; friction holds it with 6.3 N, below the 8 N of the weak gripper.
    task = job([stand(heavy), stand(SMALL).moved(0.3, 0.0)], 1, "patient/weak")
    slip = do(task, PICK, 0)
    assert slip.slipped
    assert task.observation.held is None
    assert task.poses[0].position[2] == pytest.approx(0.06, abs=2e-3)
    assert do(task, PICK, 1).reached
    assert task.observation.held == 1
    heavier = box(0.2, 0.14, 0.12)  # 13 N; friction holds it with 9.2 N.
    task = job([stand(heavier), stand(SMALL).moved(0.3, 0.0)], 1, "patient/weak")
    do(task, PUSH_APART, 0)
    assert task.poses[0].position[:2] == pytest.approx([0, 0], abs=2e-3)


@pytest.mark.parametrize(("verb", "slipped"), [(HAND_OVER_GENTLY, False), (HAND_OVER_BRISKLY, True)])
def test_a_slippery_gripper_drops_what_it_moves_briskly(verb, slipped):
    task = job([stand(SMALL)], 0, "patient/slippery")
    do(task, PICK, 0)
    events = do(task, verb, 0)
    assert events.slipped == slipped
    assert (events.handed == 0) == (not slipped)
    assert events.spilled == ((0,) if slipped else ())
