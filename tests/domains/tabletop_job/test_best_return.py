"""The best return: by hand, never below any other sequence, and above a random agent's."""

import pytest

from lifelore.domains.tabletop.layout import stand
from lifelore.domains.tabletop.shapes import box
from lifelore.domains.tabletop_job.best_return import OutcomeTree
from lifelore.domains.tabletop_job.job import TabletopJob
from lifelore.domains.tabletop_job.job_types import GRIPPERS, USERS, JobType
from lifelore.domains.tabletop_job.tray import tray_of

pytest.importorskip("mujoco", reason="needs the extra sim")
pytestmark = [pytest.mark.sim, pytest.mark.slow]

TRAY = tray_of([stand(box(0.1, 0.1, 0.06)), stand(box(0.06, 0.06, 0.05), height=0.06)], 0)
FIRM, _, SLIPPERY, _ = GRIPPERS
PATIENT, HURRIED, CAUTIOUS, CLEARING = USERS


@pytest.fixture(scope="module")
def tree():
    return OutcomeTree(TRAY, FIRM)


def words(tree, user):
    found = tree.best(user)
    assert found.bound == found.value
    return [divmod(action, 2) for action in found.actions]


def test_users_are_best_served_in_different_ways(tree):
    assert words(tree, PATIENT) == [(0, 1), (1, 1), (0, 0), (4, 0)]  # the top aside, then the bottom, briskly
    assert words(tree, HURRIED) == [(0, 0), (4, 0)]  # the spill costs less than the time
    assert words(tree, CAUTIOUS) == [(0, 1), (1, 1), (0, 0), (3, 0)]  # gently
    assert words(tree, CLEARING) == [(0, 1), (4, 1), (0, 0), (4, 0)]  # the top handed over, too


def test_a_slippery_gripper_is_best_moved_gently():
    assert words(OutcomeTree(TRAY, SLIPPERY), PATIENT)[-1] == (3, 0)


def test_values_are_those_of_the_job(tree):
    found = tree.best(PATIENT)
    task = TabletopJob(TRAY, JobType(PATIENT, FIRM))
    assert (
        sum(task.step(action)[1] for action in found.actions) == found.value == tree.value(PATIENT, found.actions)
    )


def test_every_sequence_of_three_actions_is_at_most_the_best(tree):
    best = {user.name: tree.best(user).value for user in USERS}

    def follow(actions):
        for user in USERS if tree.after(actions).state.ended else ():
            assert tree.value(user, actions) <= best[user.name] + 1e-9
        if len(actions) < 3:
            for action in tree.after(actions).available:
                follow((*actions, action))

    follow(())
