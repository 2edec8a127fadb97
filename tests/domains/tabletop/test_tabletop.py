"""The tabletop with its physics: rest, balance, truth, what the camera sees, and the same scenes however drawn."""

import subprocess
import sys

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.domains.tabletop.arrangements import ARRANGEMENTS
from lifelore.domains.tabletop.depth_camera import Camera, looking_down
from lifelore.domains.tabletop.layout import stand
from lifelore.domains.tabletop.photograph import photograph
from lifelore.domains.tabletop.physics import Tabletop
from lifelore.domains.tabletop.pose import Pose, about
from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.domains.tabletop.shapes import arch, ball, box, cylinder, hinged_blocks, torus
from lifelore.domains.tabletop.tabletop import sample_scene, settle_scene, tabletop_scenes

pytest.importorskip("mujoco", reason="needs the extra sim")
pytestmark = pytest.mark.sim

BLOCK = box(0.1, 0.1, 0.06)
CLEAN = Camera("clean", quantum=0, local_noise=0, drift=0, edge_dropout=0, shadows=False)


def settled(*things):
    table = Tabletop([thing.shape for thing in things], [thing.pose for thing in things])
    assert table.settle()
    return table


def told(*things, **settings):
    """Relations of things placed by hand, as {(a, b): relation}."""
    found = settle_scene(list(things), np.random.default_rng(0), TabletopSettings(**settings))
    return {(label.a, label.b): label.relation for label in found.truth}


@pytest.mark.parametrize(
    ("shape", "height"),
    [(BLOCK, 0.03), (cylinder(0.04, 0.12), 0.06), (ball(0.05), 0.05), (torus(0.05, 0.015), 0.015)],
)
def test_a_dropped_thing_rests_at_half_its_height(shape, height):
    pose = settled(stand(shape, height=0.02)).poses[0]
    assert pose.position[2] == pytest.approx(height, abs=2e-4)


def test_the_table_carries_what_stands_on_it():
    table = settled(stand(BLOCK), stand(BLOCK, height=0.06), stand(cylinder(0.03, 0.1), height=0.12))
    contacts = table.contacts()
    lift = np.zeros(4)
    np.add.at(lift, contacts.second, contacts.forces[:, 2])
    np.add.at(lift, contacts.first, -contacts.forces[:, 2])
    assert lift[:3] == pytest.approx(table.weights, rel=1e-3)
    assert -lift[-1] == pytest.approx(table.weights.sum(), rel=1e-3)


def test_one_box_on_another():
    assert told(stand(BLOCK), stand(BLOCK, height=0.06)) == {(2, 1): "on", (3, 1): "none", (3, 2): "on"}


@pytest.mark.parametrize(("slope", "height"), [(20, 0.06), (50, 0.1)])
def test_a_leaning_plank_is_both_and_stands_on_the_table(slope, height):
    angle = np.radians(slope)
    block, plank = stand(box(0.1, 0.15, height)), stand(box(0.25, 0.08, 0.02), about(1, angle))
    foot = plank.outline()[plank.outline()[:, 2].argmin(), 0]
    truth = told(block, plank.moved(float(0.05 + height / np.tan(angle) - foot) + 0.002, 0.0))
    assert truth == {(2, 1): "on", (3, 1): "on", (3, 2): "both"}


@pytest.mark.parametrize(("width", "accepted"), [(0.054, True), (0.066, False)])
def test_jammed_things_are_refused(width, accepted):
    # Between the legs of an arch on its back are 60 mm: a wider block is pressed from both sides and cannot leave.
    trough = stand(arch(0.16, 0.08, 0.1, foot=0.05, plate=0.02), about(0, np.pi))
    block = stand(box(width, 0.06, 0.06), height=0.02)
    found = settle_scene([trough, block], np.random.default_rng(0), TabletopSettings())
    assert (found is not None) == accepted


def test_a_hinge_bends_and_its_shape_says_so():
    # The joint lies 3 mm beyond the edge of a box, the first block on it: the second hangs down.
    table = settled(
        stand(box(0.16, 0.1, 0.12)), stand(hinged_blocks(0.1, 0.04, 0.02, 0.0), height=0.12).moved(0.083, 0.0)
    )
    now = table.poses[1].apply(table.shapes[1].outline())
    assert np.ptp(now[:, 2]) > 0.03
    assert now[:, 2].min() > -0.001


def view_down(distance=0.8):
    return looking_down(0.6, np.radians(45), 0.0, distance)


@pytest.mark.slow
def test_the_camera_measures_a_plane_and_a_ball_exactly():
    radius, centre = 0.05, np.array([0.0, 0.0, 0.05])
    table = Tabletop([ball(radius)], [Pose(centre, np.eye(3))])
    outlines = [table.poses[0].apply(ball(radius).outline())]
    photo = photograph(table, outlines, view_down(), CLEAN, np.random.default_rng(0))
    cloud = photo.cloud
    assert cloud.of(TABLE)[:, 2] == pytest.approx(0, abs=1e-9)
    assert np.linalg.norm(cloud.of(2) - centre, axis=1) == pytest.approx(radius, abs=1e-9)
    # A ball's picture is the disk of its tangent cone: tan² = r² / (d² − r²).
    d = float(np.linalg.norm(centre - view_down().position))
    assert len(cloud.of(2)) == pytest.approx(np.pi * radius**2 / (d**2 - radius**2) * 525**2, rel=0.05)
    assert photo.clean == pytest.approx(cloud.points)


def test_distances_between_shapes_are_those_of_their_surfaces():
    table = Tabletop([BLOCK, ball(0.02), BLOCK], [Pose(np.array([x, 0, 0.2]), np.eye(3)) for x in (0, 0.1, 1.0)])
    found, way = table.distance(0, 1, 0.5)
    assert found == pytest.approx(0.03, abs=1e-6)
    assert way == pytest.approx([0.03, 0, 0], abs=1e-4)
    assert table.distance(0, 2, 0.5)[0] == 0.5


def same(first, second):
    assert first.name == second.name
    assert first.truth == second.truth
    assert first.gaps == second.gaps
    assert np.array_equal(first.cloud.points, second.cloud.points)
    assert np.array_equal(first.cloud.labels, second.cloud.labels)
    assert np.array_equal(first.cloud.colours, second.cloud.colours)


@pytest.mark.slow
def test_serial_and_parallel_scenes_are_the_same():
    settings = TabletopSettings(n_objects=(2, 4))
    for first, second in zip(
        tabletop_scenes(4, 5, settings), tabletop_scenes(4, 5, settings, jobs=2), strict=True
    ):
        same(first, second)


@pytest.mark.slow
def test_pairs_meet_their_quota():
    mix = {"on": 2, "adjacent": 1, "both": 1, "none": 1}
    drawn = list(tabletop_scenes(10, 0, TabletopSettings(arrangement="pair", mix=mix)))
    relations = [label.relation for scene in drawn for label in scene.truth if label.b != TABLE]
    assert [relations.count(relation) for relation in mix] == [4, 2, 2, 2]


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(set(ARRANGEMENTS) - {"mixed", "pair"}))
def test_every_arrangement_settles(name):
    assert sample_scene(1, 0, TabletopSettings(arrangement=name)).truth


@pytest.mark.parametrize("camera", ["kinect", "stereo"])
def test_labels_are_objects_above_the_table(camera):
    scene = sample_scene(2, 1, TabletopSettings(arrangement="pair", camera=camera, shapes="held-out"))
    assert scene.cloud.objects == (2, 3)
    heights = scene.cloud.points[scene.cloud.labels > TABLE, 2]
    assert heights.min() > -0.01
    assert abs(scene.cloud.of(TABLE)[:, 2].mean()) < 0.003


def test_an_unknown_arrangement_is_refused():
    with pytest.raises(InputError, match="arrangement must be one of"):
        sample_scene(0, 0, TabletopSettings(arrangement="ring"))


@pytest.mark.slow
def test_without_mujoco_one_line_says_what_to_do():
    code = (
        "import sys; sys.modules['mujoco'] = None\n"
        "from lifelore.domains.tabletop.tabletop import sample_scene\n"
        "from lifelore.core.errors import MissingExtraError\n"
        "try: sample_scene(0, 0)\n"
        "except MissingExtraError as error: print(error)"
    )
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert told.stdout == "the tabletop needs MuJoCo: pip install 'lifelore[sim]'\n"
    assert told.stderr == ""
