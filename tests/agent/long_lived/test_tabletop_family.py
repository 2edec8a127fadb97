"""Tabletop jobs as tasks of the long-lived agent: features of trays by hand, causes and effects, plans."""

import numpy as np
import pytest

from lifelore.domains.tabletop.layout import stand
from lifelore.domains.tabletop.shapes import box
from lifelore.domains.tabletop_job.job_types import job_type_named

pytest.importorskip("mujoco", reason="needs the extra sim")
pytestmark = pytest.mark.sim

from lifelore.agent.long_lived.families import tray_states as tray_  # noqa: E402
from lifelore.agent.long_lived.families.tabletop import TabletopFamily  # noqa: E402
from lifelore.agent.long_lived.families.tabletop_task import TabletopTask, reward_bin  # noqa: E402
from lifelore.agent.long_lived.families.tray_features import look_at_raw_cloud  # noqa: E402
from lifelore.agent.long_lived.families.tray_features import look_without_relations as look_at_places  # noqa: E402
from lifelore.agent.long_lived.knowledge import Knowledge  # noqa: E402
from lifelore.agent.long_lived.live_task import live_task  # noqa: E402
from lifelore.agent.long_lived.task_family import AGENTS  # noqa: E402
from lifelore.core.errors import InputError  # noqa: E402
from lifelore.core.labelled_cloud import LabelledCloud  # noqa: E402
from lifelore.domains.tabletop_job.best_return import OutcomeTree  # noqa: E402
from lifelore.domains.tabletop_job.job import TabletopJob  # noqa: E402
from lifelore.domains.tabletop_job.job_replay import JobReplay  # noqa: E402
from lifelore.domains.tabletop_job.tray import sample_tray, tray_of  # noqa: E402
from lifelore.domains.task_stream import TaskStream  # noqa: E402
from lifelore.perception.clouds.point_cloud import PointCloud  # noqa: E402
from lifelore.perception.segmentation.table_frame import to_scene  # noqa: E402

KIND = job_type_named("patient/firm")


@pytest.fixture(scope="module")
def family():
    return TabletopFamily(TaskStream(("patient/firm", "hurried/wide"), n_contexts=1), seed=3)


def test_a_replay_is_the_job():
    tray = sample_tray(3, 0)
    job, replay = TabletopJob(tray, KIND), JobReplay(OutcomeTree(tray, KIND.gripper), KIND.user)
    for _ in range(2):
        assert replay.reset().held is job.reset().held is None
        for action in (tray.target, 3 * job.n_objects + tray.target):
            if job.ended or not job.available()[action]:
                break
            assert np.array_equal(job.available(), replay.available())
            ours, theirs = job.step(action), replay.step(action)
            assert ours[1:] == theirs[1:]
            assert (ours[0].held, ours[0].gone) == (theirs[0].held, theirs[0].gone)
    assert len(replay.tree) <= 4


def test_a_raw_cloud_of_which_no_scene_can_be_made_shows_nothing(monkeypatch):
    job = TabletopJob(sample_tray(3, 0), KIND)
    rng = np.random.default_rng(0)
    # Side by side across the view: none hides another.
    across, up = np.meshgrid(np.linspace(-1, 1, 10), np.linspace(-1, 1, 10))
    places = np.stack([across, np.zeros((10, 10)), up], axis=-1).reshape(100, 1, 3)
    lumps = places + rng.normal(0, 0.02, (100, 300, 3))
    cloud = LabelledCloud(lumps.reshape(-1, 3), np.zeros(30_000, np.int64), None, np.array([0.0, -2.0, 2.0]))
    with pytest.raises(InputError, match="objects"):
        to_scene(PointCloud(cloud.points, camera=cloud.camera), "z")
    monkeypatch.setattr(job, "look", lambda: cloud)
    assert look_at_raw_cloud(job) is None


def test_features_name_the_target_that_the_user_points_at(family):
    for number in range(2):
        tray = sample_tray(3, number)
        seen = look_at_raw_cloud(TabletopJob(tray, KIND))
        assert seen.target == tray.target
        assert seen.objects <= set(range(len(tray.shapes)))
        assert tray.target not in seen.pile(tray.target, seen.objects)
        assert tray.target not in seen.neighbours(seen.objects)


def test_acts_have_causes_and_effects(family):
    _, task = family.meet(0, AGENTS["no-perception"])
    first = task.act(tray_.PICK_TARGET)
    (cause, result), (reward_cause, found) = first.effects
    assert family.cause_name(cause).startswith("pick (nothing on it")
    assert reward_cause >= tray_.N_SITUATED
    assert found == reward_bin(first.reward)
    if result == tray_.DONE:
        assert task.act(tray_.GENTLY).ended
    task.begin()
    assert task.act(tray_.GIVE_UP).ended


def test_a_bin_of_rewards_is_no_second_reward(family):
    """An act that cost 4.39 points is learnt as a bin; its words give the bin's ends, and what it counts."""
    knocked = tray_.N_SITUATED + tray_.KNOCK
    assert family.cause_name(knocked) == "another object was knocked: points for each"
    assert family.effect_name(knocked, reward_bin(-4.39)) == "-4.5 to -4.0"
    assert family.effect_name(knocked, reward_bin(-1000.0)) == "at most -9.5"
    assert family.effect_name(knocked, reward_bin(1000.0)) == "at least +11.0"


def test_without_relations_the_agent_sees_places_alone(family):
    job = TabletopJob(sample_tray(3, 0), KIND)
    seen = look_at_places(job)
    assert seen.objects == set(range(job.n_objects))
    here = seen.objects
    assert {(seen.load(k, here), seen.room(k, here)) for k in here} == {(0, 0)}
    nearest = min(
        here - {seen.target}, key=lambda k: np.linalg.norm(job.poses[k].position - job.poses[seen.target].position)
    )
    assert seen.neighbours(here)[0] == nearest


def test_what_was_missed_is_not_tried_again_in_the_next_episode(family):
    """The same tray answers the same act alike, whatever the laws say."""
    laws = np.zeros((1, family.n_causes, family.n_effects))
    laws[:, : tray_.N_SITUATED, tray_.DONE] = 1
    laws[:, tray_.N_SITUATED :, reward_bin(1.0)] = 1
    tried, shared = np.ones(family.n_causes, bool), Knowledge.empty(family).shared
    for number in range(12):
        _, task = family.meet(number, AGENTS["full"])
        first = task.act(tray_.PICK_TARGET)
        if first.effects[0][1] == tray_.MISSED and task.state.named():
            break
    task.begin()
    again = task.plan(laws, tried, None, shared)
    assert again.acts[0] != tray_.PICK_TARGET
    contexts, best = task.best_acts(laws[0], shared)
    assert task.context in contexts
    assert not best[contexts == task.context, tray_.PICK_TARGET].any()


def test_a_single_box_is_brought_and_the_second_time_at_once():
    """The plan of known effects is the best sequence that the search finds."""
    tree = OutcomeTree(tray_of([stand(box(0.1, 0.06, 0.05))], 0), KIND.gripper)
    family = TabletopFamily(TaskStream(("patient/firm",), n_contexts=1))
    knowledge, returns = Knowledge.empty(family), []
    for number in range(3):
        drawn = family.stream.draw(number)
        task = TabletopTask(JobReplay(tree, KIND.user), look_at_places)
        lived, news = live_task(knowledge, drawn, task, AGENTS["full"], f"r.{number}", n_episodes=6)
        knowledge.learn(news)
        returns.append(lived.returns)
    best = tree.best(KIND.user).value
    assert returns[0][0] < best
    assert returns[-1][0] > best - 0.5


def test_the_hidden_type_is_not_read():
    """Before the first act, tasks of different users and grippers look alike and are planned alike."""
    tray, shared = sample_tray(3, 1), Knowledge.empty(TabletopFamily(TaskStream(("patient/firm",)))).shared
    found = []
    for name in ("patient/firm", "hurried/wide"):
        kind = job_type_named(name)
        task = TabletopTask(JobReplay(OutcomeTree(tray, kind.gripper), kind.user))
        family = TabletopFamily(TaskStream(("patient/firm",)))
        laws = np.repeat(family.possible[None], 2, axis=0)
        found.append((task.context, task.describe(), task.plan(laws, np.ones(family.n_causes, bool), 1, shared)))
    assert found[0][:2] == found[1][:2]
    np.testing.assert_array_equal(found[0][2].values, found[1][2].values)
