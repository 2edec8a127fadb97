"""Scenes without a table, and labels that count from 0."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, UNLABELLED, LabelledCloud
from lifelore.perception import perceived_scene, read_cloud, to_scene
from lifelore.perception.reasoning.fact import Fact
from lifelore.perception.reasoning.planning_problem import scene_problem
from lifelore.perception.reasoning.planning_state import NO_TABLE, scene_state
from lifelore.perception.scene_json import scene_document


@pytest.fixture
def tower(box) -> dict[int, np.ndarray]:
    """Object 3 rests on 2; 4 stands beside them, 3 cm away."""
    return {
        2: box([0, 0, 0.002], [0.08, 0.08, 0.05]),
        3: box([0.02, 0.02, 0.052], [0.06, 0.06, 0.1]),
        4: box([0.11, 0, 0.002], [0.16, 0.08, 0.06]),
    }


def cloud_of(parts: dict[int, np.ndarray]) -> LabelledCloud:
    return LabelledCloud(np.vstack([*parts.values()]), np.repeat([*parts], [len(part) for part in parts.values()]))


def test_where_no_table_was_seen_nothing_is_said_to_be_on_it(tower, box):
    with_table = perceived_scene(cloud_of({TABLE: box([-0.2, -0.2, -0.01], [0.3, 0.3, 0]), **tower}))
    assert {(r.relation, r.a, r.b) for r in with_table.relations} >= {
        ("on", 2, TABLE),
        ("on", 3, 2),
        ("on", 4, TABLE),
    }
    assert not [one for one in scene_state(with_table).unknown if one.reason == NO_TABLE]

    scene = perceived_scene(cloud_of(tower))
    assert scene.relation_of(3, 2).relation == "on"
    assert not [r for r in scene.relations if TABLE in (r.a, r.b)]
    state = scene_state(scene)
    unknown = {one.fact: one for one in state.unknown}
    assert set(unknown) == {Fact("on", (2, TABLE)), Fact("on", (4, TABLE))}
    assert {one.reason for one in unknown.values()} == {NO_TABLE}
    assert all(0.5 < one.probability <= 1 for one in unknown.values())
    assert Fact("clear", (3,)) in state.stated
    assert not [fact for fact in state.stated if TABLE in fact.arguments]
    document = scene_document(scene)
    assert "table" not in " ".join(document["facts"])
    assert {"on(3, 2)", "clear(3)", "clear(4)", "ec(2, 3)", "dc(3, 4)"} <= set(document["facts"])
    assert [one["reason"] for one in document["unknown"]] == [NO_TABLE, NO_TABLE]


def test_a_planning_problem_without_a_table_lists_what_is_unknown(tower):
    text = scene_problem(perceived_scene(cloud_of(tower)), 0.6)
    comments, problem = text.split("(define")
    assert "(on-table o2) no table, probability" in comments
    assert "on-table" not in problem
    assert "(on o3 o2)" in problem


def test_two_objects_labelled_0_and_1_are_refused_and_an_empty_table_is_none(tower, box):
    pair = {0: tower[2], 1: tower[3]}
    with pytest.raises(
        InputError, match=r"got 0 and 1 alone, .* 5 cm high and 4 cm wide, .* add 2 to every label"
    ):
        perceived_scene(cloud_of(pair))
    shifted = cloud_of({label + 2: points for label, points in pair.items()})
    assert perceived_scene(shifted).relation_of(3, 2).relation == "on"
    bare = cloud_of({TABLE: box([-0.2, -0.2, -0.01], [0.3, 0.3, 0]), UNLABELLED: tower[2]})
    assert perceived_scene(bare).relations == ()


def test_a_cloud_that_is_not_upright_or_not_in_metres_is_refused(tower, box):
    cloud = cloud_of({TABLE: box([-0.2, -0.2, -0.01], [0.3, 0.3, 0]), **tower})
    tilt = np.array([[1, 0, 0], [0, 0.8, -0.6], [0, 0.6, 0.8]])  # by 37°
    with pytest.raises(InputError, match=r"and z up, but .* no level table: .* to_scene\(read_cloud\(rows\)\)"):
        perceived_scene(LabelledCloud(cloud.points @ tilt.T, cloud.labels))
    with pytest.raises(InputError, match="points must be in metres, and at most 20 m wide, got 500; divide"):
        perceived_scene(LabelledCloud(1000 * cloud.points, cloud.labels))


def test_a_table_may_be_labelled_with_what_is_below_its_top(tower, box):
    shelf = np.concatenate([box([-0.3, -0.3, -0.01], [0.4, 0.4, 0]), box([-0.3, 0, -0.5], [0.4, 0.4, -0.49])])
    assert perceived_scene(cloud_of({TABLE: shelf, **tower})).relation_of(3, 2).relation == "on"
    with pytest.raises(InputError, match="number objects from 2"):  # a tower numbered from 1 has such sides, too
        perceived_scene(cloud_of({label - 1: points for label, points in tower.items()}))


@pytest.mark.parametrize("labels", [np.array([1.0, 2.0]), np.array(["table", "cup"]), np.array([-1, 2])])
def test_labels_are_whole_numbers(labels):
    with pytest.raises(InputError, match=f"labels must be 2 whole numbers from 0, got .* of {labels.dtype}"):
        LabelledCloud(np.zeros((2, 3)), labels)


@pytest.mark.parametrize(("of_points", "of_labels"), [("<f4", "u1"), (">f8", "u8"), ("<f2", "i2")])
def test_points_and_labels_may_be_any_kind_of_numbers(tower, of_points, of_labels):
    cloud = cloud_of(tower)
    scene = perceived_scene(LabelledCloud(cloud.points.astype(of_points), cloud.labels.astype(of_labels)))
    assert scene.relation_of(3, 2).relation == "on"


def test_each_step_from_a_file_to_a_scene_says_what_it_takes():
    points = np.zeros((40, 3))
    with pytest.raises(InputError, match=r"source must be a path or an array of points, got list"):
        read_cloud([[0.0, 0.0, 0.0]])
    with pytest.raises(InputError, match=r"cloud must be a PointCloud \(read_cloud makes one\), got ndarray"):
        to_scene(points)
    with pytest.raises(InputError, match=r"cloud must be a LabelledCloud \(to_scene makes one\), got PointCloud"):
        perceived_scene(read_cloud(points))
