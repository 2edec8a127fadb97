"""The tabletop job: rewards by hand, determinism, copies, looks, and refusals."""

import pickle

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.labelled_cloud import UNLABELLED
from lifelore.domains.tabletop.layout import stand
from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.domains.tabletop.shapes import box
from lifelore.domains.tabletop_job.events import Events
from lifelore.domains.tabletop_job.job import (
    HAND_OVER_BRISKLY,
    HAND_OVER_GENTLY,
    LONGEST,
    PICK,
    PUSH_APART,
    PUT_ASIDE,
    TabletopJob,
    reward_of,
)
from lifelore.domains.tabletop_job.job_types import JOB_TYPES, USERS, job_type_named
from lifelore.domains.tabletop_job.tray import TARGET_WEIGHT, _sampled, sample_tray, tray_of

pytest.importorskip("mujoco", reason="needs the extra sim")
pytestmark = pytest.mark.sim

BLOCK, SMALL = box(0.1, 0.1, 0.06), box(0.06, 0.06, 0.05)


def stack(name="patient/firm", target=1):
    return TabletopJob(tray_of([stand(BLOCK), stand(SMALL, height=0.06)], target), job_type_named(name))


def run(task, *actions):
    task.reset()
    return [task.step(verb * task.n_objects + number) for verb, number in actions]


def test_points_of_a_job_by_hand():
    (_, first, _), (_, second, ended) = run(stack(), (PICK, 1), (HAND_OVER_BRISKLY, 1))
    # Patient: 0.2 points a second. Pick: 2 s of approach, 0.2 s down, 0.34 m up at 0.4 m/s and 1 m/s², 0.7 s fold.
    lift = 0.34 / 0.4 + 0.4
    assert first == pytest.approx(-0.2 * (2 + lift + 0.7), abs=0.06)
    # Hand over: 2 s of approach, about 1 m at 1.2 m/s and 10 m/s².
    assert second == pytest.approx(10 - 0.2 * (2 + 1 / 1.2 + 0.12), abs=0.02)
    assert ended


def test_users_differ_as_documented():
    bring = Events(5.0, handed=0)
    spill, aside = Events(5.0, spilled=(1,), knocked=(2,)), Events(5.0, put_aside=1)
    other = Events(5.0, handed=1)
    points = {
        user.name: (
            reward_of(user, bring, False, 0),
            reward_of(user, bring, True, 0),
            reward_of(user, spill, False, 0),
            reward_of(user, aside, False, 0),
            reward_of(user, other, False, 0),
        )
        for user in USERS
    }
    assert points["patient"] == pytest.approx((9, 9, -7, -1, -4))
    assert points["hurried"] == pytest.approx((7, 8, -6.5, -3, -6))
    assert points["cautious"] == pytest.approx((9, 5, -11, -1, -4))
    assert points["clearing"] == pytest.approx((8.5, 8.5, -7.5, -4.5, -1.5))


def test_actions_follow_the_hand():
    task = stack()

    def verbs():
        return set((np.flatnonzero(task.available()) // 2).tolist())

    assert verbs() == {PICK, PUSH_APART, 5}
    task.step(1)
    assert verbs() == {PUT_ASIDE, HAND_OVER_GENTLY, HAND_OVER_BRISKLY, 5}
    with pytest.raises(InputError, match=r"action must be one of \[3, 7, 9, 10\]"):
        task.step(0)
    _, reward, ended = task.step(10)
    assert (reward, ended) == (0.0, True)
    assert not task.available().any()


def test_a_job_is_cut():
    task = stack()
    for k in range(LONGEST):
        assert not task.ended
        task.step(2 * PUSH_APART + k % 2)
    assert task.ended


def trace(task, actions):
    out = []
    for action in actions:
        _, reward, _ = task.step(action)
        out.append((reward, [pose.position.tolist() for pose in task.poses]))
    return out


def test_a_copied_state_goes_on_as_the_original_even_pickled():
    actions = (1, 3, 0, 8)
    for at in range(4):
        task, other = stack(), stack()
        trace(task, actions[:at])
        state = pickle.loads(pickle.dumps(task.copy_state()))
        trace(other, (4, 5))
        other.restore(state)
        assert other.observation.held == task.observation.held
        assert trace(other, actions[at:]) == trace(task, actions[at:])


@pytest.mark.slow
def test_looks_carry_neither_labels_nor_colours_and_show_what_is_left():
    tray = sample_tray(0, 3)
    task = TabletopJob(tray, JOB_TYPES[0])
    first = task.look()
    assert (set(first.labels.tolist()), first.colours) == ({UNLABELLED}, None)
    assert np.array_equal(first.points, tray.cloud.points)
    assert task.object_at(tray.pointed) == tray.target
    task.step(tray.target)
    task.step(HAND_OVER_GENTLY * task.n_objects + tray.target)
    later = task.look()
    assert np.array_equal(later.points, task.look().points)
    taken = tray.cloud.of(tray.target + 2)
    assert np.linalg.norm(later.points - taken[taken[:, 2].argmax()], axis=1).min() > 0.01


@pytest.mark.slow
def test_trays_depend_on_their_seed_and_number_alone():
    first = sample_tray(5, 1)
    _sampled.cache_clear()
    second = sample_tray(5, 1)
    assert second is not first
    assert first.target == second.target
    assert np.array_equal(first.cloud.points, second.cloud.points)
    assert pickle.loads(pickle.dumps(first)).target == first.target
    assert 2 <= len(first.shapes) <= 7
    assert TabletopJob(first, JOB_TYPES[0])._physics.weights[first.target] <= TARGET_WEIGHT


def test_unknown_types_and_trays_of_a_mix_are_refused():
    with pytest.raises(NotFoundError, match="type must be one of"):
        job_type_named("kind/firm")
    with pytest.raises(InputError, match="mix must be None"):
        sample_tray(1, 0, TabletopSettings(arrangement="pair", mix={"on": 1.0}))
