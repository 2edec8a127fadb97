"""Scenes of words: cells, placements, truth by shapes, the other side of the table, and compounds by hand."""

from types import SimpleNamespace

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.domains.tabletop.depth_camera import CAMERAS
from lifelore.domains.tabletop.photograph import choose_view, photograph
from lifelore.domains.tabletop.pose import Pose
from lifelore.domains.tabletop.shapes import ball, box, cup
from reproduction.chapter5.c5_01_more_relations import run as word_scenes
from reproduction.chapter5.c5_01_more_relations.run import (
    KINDS,
    compound_facts,
    from_the_other_side,
    labels_of,
    outlines,
    place_angle,
    place_in_cup,
    run_cell,
    seen,
    true_compounds,
)
from reproduction.chapter5.c5_01_more_relations.run import cells as word_cells

CUBE = box(0.06, 0.06, 0.06)


def at(x: float, y: float, z: float = 0.03) -> Pose:
    return Pose(np.array([x, y, z]), np.eye(3))


def surface(low, size, step=0.004) -> np.ndarray:
    axes = [np.arange(0, side + step / 2, step) for side in size]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    last = np.array([axis[-1] for axis in axes])
    return grid[((grid == 0) | (grid == last)).any(axis=1)] + np.array(low)


def made(poses: list[Pose], truth: list[PairLabel], shapes=None) -> SimpleNamespace:
    """Cubes (or other shapes) where they are put, and what is true of them; the cubes' surfaces as the cloud."""
    parts = [surface(pose.position - 0.03, (0.06,) * 3) for pose in poses]
    cloud = LabelledCloud(
        np.concatenate(parts),
        np.repeat(np.arange(2, 2 + len(parts)), [len(part) for part in parts]),
        None,
        np.array([0.0, -0.7, 0.5]),
    )
    return SimpleNamespace(shapes=shapes or [CUBE] * len(poses), poses=poses, cloud=cloud, truth=tuple(truth))


ON_TABLE = [PairLabel(label, TABLE, "on") for label in (2, 3, 4)]
ROW = made(
    [at(-0.065, 0), at(0, 0), at(0.065, 0)],
    [*ON_TABLE, PairLabel(2, 3, "adjacent"), PairLabel(4, 3, "adjacent"), PairLabel(2, 4, "none")],
)
ANGLE = made(
    [at(-0.065, 0), at(0, 0), at(0, 0.065)],
    [*ON_TABLE, PairLabel(2, 3, "adjacent"), PairLabel(4, 3, "adjacent"), PairLabel(2, 4, "none")],
)


def test_cells_are_lots_of_lessons_scenes_and_kinds():
    cells = word_cells({"lessons": [4, 12], "scenes": 9, "compound": 20})
    assert cells[:2] == [{"kind": "lesson", "first": 0}, {"kind": "lesson", "first": 8}]
    assert cells[2:4] == [{"kind": "held-out", "first": 0}, {"kind": "held-out", "first": 8}]
    assert [(cell["of"], cell["first"]) for cell in cells[4:]] == [(kind, k) for kind in KINDS for k in (0, 10)]
    assert len({cell["model"] for cell in cells[4:]}) == 1


def test_a_cell_draws_its_own_numbers_of_its_own_kind(monkeypatch):
    drawn = []

    def scene(name, *of):
        drawn.append((name, *of))
        return SimpleNamespace(cloud=None)

    monkeypatch.setattr(word_scenes, "_drawn", lambda seed, shapes, number: scene("drawn", shapes, number))
    monkeypatch.setattr(word_scenes, "seen", lambda scene, cloud: {})
    monkeypatch.setattr(word_scenes, "compound_facts", lambda scene: {})
    monkeypatch.setattr(word_scenes, "arranged", lambda name, seed, number: scene(name, number))
    settings = {"lessons": [10], "scenes": 1, "compound": 12}
    found = run_cell(settings, {"kind": "lesson", "first": 8}, 0)
    assert (found["kind"], len(found["scenes"])) == ("lesson", 2)
    assert run_cell(settings, {"kind": "compound", "of": "row", "first": 10}, 0)["of"] == "row"
    assert run_cell(settings, {"kind": "compound", "of": "mixed", "first": 11}, 0)["of"] == "mixed"
    assert drawn == [
        ("drawn", "training", 8),
        ("drawn", "training", 9),
        ("row", 10),
        ("row", 11),
        ("drawn", "held-out", 11),
    ]


@pytest.mark.parametrize("seed", range(5))
def test_an_angle_is_a_right_one(seed):
    middle, *others = place_angle(np.random.default_rng(seed))
    ways = [(one.outline().mean(axis=0) - middle.outline().mean(axis=0))[:2] for one in others]
    first, second = (way / np.linalg.norm(way) for way in ways)
    # Blocks up to 100 mm wide are not quite where their neighbour's middle is.
    assert abs(np.degrees(np.arccos(first @ second)) - 90) < 8
    for one in others:
        apart = np.linalg.norm(one.outline()[:, None] - middle.outline()[None], axis=-1).min()
        assert apart < 0.06


@pytest.mark.parametrize("seed", range(5))
def test_the_ball_goes_into_the_cup(seed):
    vessel, inner = place_in_cup(np.random.default_rng(seed))
    rim, thing = vessel.outline(), inner.outline()
    radius = np.ptp(thing[:, 0]) / 2
    assert 0.02 < radius <= 0.03
    middle = (thing.min(axis=0) + thing.max(axis=0))[:2] / 2
    inside = np.hypot(*rim[rim[:, 2] > rim[:, 2].max() - 0.02][:, :2].T).min()
    assert np.hypot(*middle) + 0.02 < inside
    # Above the floor, below the rim.
    assert 0 < thing[:, 2].min() < rim[:, 2].max()


def test_outlines_are_where_the_things_are():
    spans = outlines(ROW)  # type: ignore[arg-type]
    assert list(spans) == [2, 3, 4]
    assert spans[2].min(axis=0) == pytest.approx([-0.095, -0.03, 0])
    assert spans[4].max(axis=0) == pytest.approx([0.095, 0.03, 0.06])


def test_what_is_seen_of_a_row_of_two_by_hand():
    scene = made([at(-0.035, 0), at(0.035, 0)], [PairLabel(3, 2, "adjacent"), *ON_TABLE[:2]])
    found = seen(scene, scene.cloud)  # type: ignore[arg-type]
    assert found["labelled"] == [(2, 3)]
    # The camera looks along +y, so that right is +x.
    assert found["truth"] == found["by_rule"] == [[2, 3, "left_of"], [3, 2, "right_of"]]
    assert found["pairs"] == [[2, 3], [3, 2]]
    assert found["gaps"] == pytest.approx([0.01, 0.01], abs=1e-4)
    assert len(found["features"]) == 2
    assert [label.relation for label in labels_of(found["truth"])] == ["left_of", "right_of"]
    # By what is visible of 3, its near half alone, it is in front too: 30 mm to the right, 30 mm nearer.
    visible = np.flatnonzero((scene.cloud.labels == 2) | (scene.cloud.points[:, 1] < -0.022))
    half = LabelledCloud(scene.cloud.points[visible], scene.cloud.labels[visible], None, scene.cloud.camera)
    near = seen(scene, half)  # type: ignore[arg-type]
    assert near["truth"] == found["truth"]
    assert [3, 2, "right_of"] in near["by_rule"]


def test_between_is_a_row_and_not_an_angle():
    assert true_compounds(ROW) == {("between", (3, 2, 4))}  # type: ignore[arg-type]
    assert true_compounds(ANGLE) == set()  # type: ignore[arg-type]
    # Both must be near what stands between them.
    far = made(ROW.poses, [label for label in ROW.truth if label.a != 4])
    assert true_compounds(far) == set()  # type: ignore[arg-type]


def test_in_is_a_cup_whether_or_not_it_is_called_on_and_adjacent():
    vessel = cup(0.04, 0.045, 0.06, 0.005, False)
    nested = made([at(0, 0), at(0, 0)], [PairLabel(3, 2, "on")], [vessel, ball(0.02)])
    assert true_compounds(nested) == {("in", (3, 2))}  # type: ignore[arg-type]
    # Beside the cup; and too far for anybody to have labelled the pair.
    beside = made([at(0, 0), at(0.07, 0)], [PairLabel(2, 3, "adjacent")], [vessel, ball(0.02)])
    assert true_compounds(beside) == set()  # type: ignore[arg-type]
    assert true_compounds(made(nested.poses, [], [vessel, ball(0.02)])) == set()  # type: ignore[arg-type]


def test_the_thesiss_rules_on_what_is_true():
    row, angle = compound_facts(ROW), compound_facts(ANGLE)  # type: ignore[arg-type]
    assert row["true"] == row["thesis"] == [["between", 3, 2, 4]]
    # Two different adjacents, and not between: a counterexample.
    assert (angle["true"], angle["thesis"]) == ([], [["between", 3, 2, 4]])
    # By the points the row is between and the angle is not.
    assert row["lifelore"] == [["between", 3, 2, 4]]
    assert angle["lifelore"] == []
    leaning = made([at(0, 0), at(0.04, 0, 0.06)], [PairLabel(3, 2, "both"), *ON_TABLE[:2]])
    found = compound_facts(leaning)  # type: ignore[arg-type]
    assert (found["true"], found["thesis"]) == ([], [["in", 3, 2]])


def test_between_needs_no_adjacent():
    """Erratum: the middle one of a row is between its neighbours without touching them, and the rule misses it."""
    none = [PairLabel(2, 3, "none"), PairLabel(4, 3, "none"), PairLabel(2, 4, "none")]
    apart = made([at(-0.09, 0), at(0, 0), at(0.09, 0)], [*ON_TABLE, *none])
    found = compound_facts(apart)  # type: ignore[arg-type]
    assert (found["true"], found["thesis"]) == ([["between", 3, 2, 4]], [])


def test_the_other_side_of_the_table():
    pytest.importorskip("mujoco")
    from lifelore.domains.tabletop.physics import Tabletop

    poses = [at(-0.05, 0), at(0.05, 0)]
    scene = made(poses, [PairLabel(2, 3, "none"), *ON_TABLE[:2]])
    spans = list(outlines(scene).values())  # type: ignore[arg-type]
    view = choose_view(spans, np.random.default_rng(0), CAMERAS["kinect"])
    assert view is not None
    photo = photograph(Tabletop(scene.shapes, poses), spans, view, CAMERAS["kinect"], np.random.default_rng(1))
    assert photo is not None
    scene.cloud, scene.view = photo.cloud, view
    behind = from_the_other_side(scene, np.random.default_rng(2))  # type: ignore[arg-type]
    assert behind is not None
    assert behind.camera is not None
    # Half a turn about the middle of the things, which is the origin: across the table, as high as before.
    assert behind.camera == pytest.approx(view.position * [-1, -1, 1])
    front, back = seen(scene, photo.cloud), seen(scene, behind)  # type: ignore[arg-type]
    assert front["truth"] == [[2, 3, "left_of"], [3, 2, "right_of"]]
    assert back["truth"] == [[2, 3, "right_of"], [3, 2, "left_of"]]
    # Each camera sees its own side of the things.
    sides = [cloud.of(2)[:, 1].mean() for cloud in (photo.cloud, behind)]
    assert sides[0] < 0 < sides[1]
    # A small thing right behind a wall is hidden from there, and the scene is left out.
    wall = made([at(0, 0.16), at(0, 0.2, 0.1)], [], [box(0.03, 0.03, 0.06), box(0.4, 0.02, 0.2)])
    wall.view = view
    assert from_the_other_side(wall, np.random.default_rng(0)) is None  # type: ignore[arg-type]
