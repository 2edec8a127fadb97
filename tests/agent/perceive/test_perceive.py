"""The verb perceive: a box on a slab told from its points alone, the files it writes, and models by name."""

import json
import time
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.perceive.perceive import STAGES, PerceiveSettings, perceive
from lifelore.agent.perceive.relation_memory import store_model
from lifelore.agent.perceive.scene_files import domain_path
from lifelore.bridges.planner import Step
from lifelore.core.errors import InputError, NotFoundError
from lifelore.memory import open_memory
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.relations.relation_classifier import SHIPPED, shipped_model
from lifelore.perception.segmentation.object_segmentation import SegmentationSettings

CAMERA = np.array([0.3, -0.9, 0.7])


def seen_box(low, high, spacing=0.002):
    """Points on the faces of an axis-parallel box that `CAMERA` sees."""
    low, high = np.array(low, float), np.array(high, float)
    parts = []
    for axis in range(3):
        for end, outside in ((low[axis], CAMERA[axis] < low[axis]), (high[axis], CAMERA[axis] > high[axis])):
            if outside:
                steps = [np.arange(a, b, spacing) for a, b in zip(low, high, strict=True)]
                steps[axis] = np.array([end])
                parts.append(np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1).reshape(-1, 3))
    return np.concatenate(parts)


@pytest.fixture(scope="module")
def pile(tmp_path_factory):
    """A box (3) on a slab (2) on the table, with a box (4) apart; z up."""
    table = np.stack(np.meshgrid(np.arange(-0.3, 0.6, 0.004), np.arange(-0.3, 0.6, 0.004)), axis=-1).reshape(-1, 2)
    table = np.column_stack([table, np.zeros(len(table))])
    hidden = ((table[:, :2] > 0) & (table[:, :2] < [0.2, 0.15])).all(axis=1)
    clouds = {
        1: table[~hidden],
        2: seen_box([0, 0, 0], [0.2, 0.15, 0.05]),
        3: seen_box([0.05, 0.04, 0.05], [0.13, 0.1, 0.17]),
        4: seen_box([0.4, 0.1, 0], [0.48, 0.16, 0.1]),
    }
    path = tmp_path_factory.mktemp("clouds") / "pile.npz"
    labels = np.repeat(list(clouds), [len(points) for points in clouds.values()])
    np.savez(path, points=np.concatenate(list(clouds.values())), labels=labels)
    return path


@pytest.fixture(scope="module")
def document(pile):
    return perceive(pile, PerceiveSettings(up="z"))


def said(document):
    return {(r["relation"], r["a"], r["b"]) for r in document["relations"] if r["relation"] != "none"}


@pytest.mark.slow
def test_a_box_on_a_slab_and_one_apart(document):
    assert said(document) == {("on", 3, 2), ("on", 2, "table"), ("on", 4, "table")}
    assert [entry["id"] for entry in document["objects"]] == [2, 3, 4]
    assert {"clear(3)", "clear(4)", "supports*(2, 3)"} <= set(document["facts"])
    assert document["seconds"] > 0
    assert json.loads(json.dumps(document, allow_nan=False)) == document


@pytest.mark.slow
def test_the_boxes_are_where_the_boxes_stand(document):
    places = {2: ([0.1, 0.075, 0.025], [0.2, 0.15, 0.05]), 3: ([0.09, 0.07, 0.11], [0.08, 0.06, 0.12])}
    for number, (centre, size) in places.items():
        one = document["objects"][number - 2]
        assert one["box"]["centre"] == one["box_camera"]["centre"] == pytest.approx(centre, abs=0.002)
        assert one["box"]["size"] == pytest.approx(size, abs=0.003)
        assert np.abs(one["box"]["axes"]) == pytest.approx(np.eye(3), abs=0.02)
        assert one["top"] == pytest.approx(centre[2] + size[2] / 2, abs=0.002)
    supports = [one["support"] for one in document["objects"]]
    assert supports == pytest.approx([0, 0.05, 0], abs=0.002)


@pytest.mark.slow
def test_the_contact_lies_between_the_two(document):
    upper = document["objects"][1]
    towards = [np.array(c["xyz"]) for c in upper["contact_points"] if c["other"] == 2]
    assert towards
    assert all(abs(at[2] - 0.05) < 0.015 for at in towards)


@pytest.mark.slow
def test_up_makes_no_difference_where_the_table_is_seen(pile, document):
    for up in ("table", (0, 0, 3.0)):
        assert said(perceive(pile, PerceiveSettings(up=up))) == said(document)


@pytest.mark.slow
def test_files_for_planners_and_people(pile, tmp_path):
    problem, graph, picture = (tmp_path / name for name in ("scene.pddl", "scene.dot", "scene.png"))
    perceive(pile, PerceiveSettings(up="z"), pddl=str(problem), dot=str(graph), plot=str(picture))
    assert "(:init" in problem.read_text("utf-8")
    assert "(define (domain tabletop)" in Path(domain_path(str(problem))).read_text("utf-8")
    assert graph.read_text("utf-8").startswith("digraph scene {")
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
def test_a_model_by_file_and_by_name_in_memory(pile, document, tmp_path):
    assert said(perceive(pile, PerceiveSettings(up="z", model=str(SHIPPED)))) == said(document)
    place = str(tmp_path / "lore.db")
    with open_memory(place) as memory:
        store_model(memory, "mine", shipped_model(), {"name": "mine"})
    assert said(perceive(pile, PerceiveSettings(up="z", model="mine", memory=place))) == said(document)
    with pytest.raises(NotFoundError, match="mine"):
        perceive(pile, PerceiveSettings(model="other", memory=place))


@pytest.mark.slow
def test_without_labels_the_same_objects_are_found_and_say_how_surely_they_were_cut(pile, document):
    points, labels = (np.load(pile)[key] for key in ("points", "labels"))
    cloud = PointCloud(points, camera=np.array([0.2, -0.9, 0.8]))
    found = perceive(cloud, PerceiveSettings(up="z"))
    for true in (2, 3, 4):
        centre = points[(labels == true) & (points[:, 2] > 0.01)].mean(axis=0)
        near = [o for o in found["objects"] if np.linalg.norm(np.array(o["centroid"]) - centre) < 0.02]
        assert len(near) == 1
        assert 0.5 < near[0]["cut_confidence"] <= 1
    assert len(found["objects"]) == 3
    # Labels that are given are not in doubt.
    assert not any("cut_confidence" in o for o in document["objects"])


@pytest.mark.slow
def test_the_seconds_hold_all_that_was_found(pile, monkeypatch):
    from lifelore.perception import scene_json

    def slow(scene, **options):
        time.sleep(0.4)
        return {"made": "late"}

    monkeypatch.setattr(scene_json, "scene_document", slow)
    document = perceive(pile, PerceiveSettings(up="z"))
    assert document.pop("seconds") > 0.4
    assert document == {"made": "late", "warnings": []}


@pytest.mark.slow
def test_each_stage_is_told_as_it_begins(pile):
    told = []
    perceive(pile, PerceiveSettings(up="z"), progress=lambda *step: told.append(step))
    assert told == [(number, len(STAGES), stage) for number, stage in enumerate(STAGES)]


@pytest.mark.parametrize(
    ("rule", "objects", "notices"), [("auto", [2], 1), ("parts", [2], 0), ("plain", [20, 21], 0)]
)
def test_a_guess_of_parts_is_told(tmp_path, rule, objects, notices):
    cube = seen_box([0, 0, 0], [0.05, 0.05, 0.05], 0.005)
    np.savez(tmp_path / "c.npz", points=np.vstack([cube, cube + 0.2]), labels=np.repeat([20, 21], len(cube)))
    told = []
    document = perceive(tmp_path / "c.npz", PerceiveSettings(up="z", labels=rule), notice=told.append)
    assert [entry["id"] for entry in document["objects"]] == objects
    assert len(told) == notices
    assert all("--labels plain" in line for line in told)


def test_a_memory_that_is_not_there_is_not_made(tmp_path):
    place = tmp_path / "no" / "m.db"
    with pytest.raises(NotFoundError, match=f"no relation model 'mine': there is no memory at {place}"):
        perceive("cloud.pcd", PerceiveSettings(model="mine", memory=str(place)))
    assert list(tmp_path.iterdir()) == []


def test_a_cut_that_would_not_be_made_is_refused(pile):
    with pytest.raises(InputError, match="leave it out"):
        perceive(pile, PerceiveSettings(segmentation=SegmentationSettings()))


@pytest.mark.parametrize("camera", [1e200, -1e9])
def test_a_camera_beyond_the_world_is_refused(camera):
    cloud = PointCloud(np.eye(3), camera=np.array([0.0, 0, camera]))
    with pytest.raises(InputError, match="camera must stand within"):
        perceive(cloud, PerceiveSettings(up="z"))


@pytest.mark.parametrize("output", ["pddl", "dot", "plot"])
def test_an_output_that_cannot_be_written_is_told_before_the_work(tmp_path, output):
    with pytest.raises(InputError, match="must be a file"):
        perceive("no such cloud.pcd", **{output: str(tmp_path)})
    with pytest.raises(InputError, match="cannot be written"):
        perceive("no such cloud.pcd", **{output: str(tmp_path / "no" / "file")})


def test_a_planner_of_your_own_plans_in_the_scene(pile):
    asked = []

    def solve(domain, problem):
        asked.append((domain, problem))
        return [Step("pick-up", ("o3",)), Step("put-on", ("o3", "o4"))]

    plan = perceive(pile, PerceiveSettings(up="z", goal="on(o3, o4)", planner=solve))["plan"]
    ((domain, problem),) = asked
    assert domain.startswith("(define (domain")
    assert "(:goal (on o3 o4))" in problem
    assert [[one["id"] for one in step["objects"]] for step in plan["steps"]] == [[3], [3, 4]]
    (first,) = plan["steps"][0]["objects"]
    np.testing.assert_allclose(first["centroid"][:2], [0.09, 0.07], atol=0.03)
    assert plan["reason"] is None
    with pytest.raises(InputError, match="needs a goal"):
        PerceiveSettings(planner=solve)
