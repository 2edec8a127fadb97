"""`bench pictures`: what is found, missing and wrong by hand; which scenes; nothing without them; one picture."""

import json
import os

import numpy as np
import pytest

from benchmarks.perception import pictures
from benchmarks.perception.pictures import bench_pictures, draw_and_judge, judge, most_labelled
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.relations.relation import Relation
from lifelore.perception.relations.relation_truth import read_relations
from lifelore.perception.segmentation.table_frame import to_scene
from reproduction.chapter2.scenes.real_scenes import RealScene, real_scenes_folder


def said(*relations: tuple[str, int, int]) -> list[Relation]:
    return [Relation(a, b, name, 1.0, 0.0) for name, a, b in relations]


TRUTH = [
    PairLabel(3, 2, "on"),
    PairLabel(5, 4, "adjacent", 2),
    PairLabel(2, 4, "none"),
    PairLabel(2, 5, "adjacent", 1),
    PairLabel(6, 3, "both"),
    PairLabel(2, TABLE, "on"),
]


def test_found_missing_and_wrong_by_hand():
    found = judge(
        TRUTH, said(("on", 3, 2), ("adjacent", 4, 5), ("adjacent", 2, 4), ("on", 6, 3), ("adjacent", 3, 4))
    )
    # (2, 5) is doubtful: neither expected nor wrong. Of (6, 3) something else is said; nobody listed (3, 4).
    assert found == {
        "pairs": 5,
        "expected": ["adjacent(4, 5)", "both(6, 3)", "on(3, 2)", "on(2, table)"],
        "found": ["adjacent(4, 5)", "on(3, 2)"],
        "missing": ["both(6, 3)", "on(2, table)"],
        "wrong": ["adjacent(2, 4)", "adjacent(3, 4)", "on(6, 3)"],
    }


@pytest.mark.parametrize(
    ("told", "missing", "wrong"),
    [
        # A relation with a direction is wrong the other way round; adjacent has none.
        (("on", 3, 2), [], []),
        (("on", 2, 3), ["on(3, 2)"], ["on(2, 3)"]),
        (("adjacent", 2, 3), ["on(3, 2)"], ["adjacent(2, 3)"]),
        # Saying none is saying nothing.
        (("none", 2, 3), ["on(3, 2)"], []),
    ],
)
def test_the_direction_counts(told, missing, wrong):
    found = judge([PairLabel(3, 2, "on")], said(told))
    assert (found["missing"], found["wrong"]) == (missing, wrong)


@pytest.mark.parametrize("order", [(2, 3), (3, 2)])
@pytest.mark.parametrize("label", [(2, 3), (3, 2)])
def test_adjacent_has_no_order(order, label):
    found = judge([PairLabel(label[0], label[1], "adjacent")], said(("adjacent", *order)))
    assert (found["found"], found["missing"], found["wrong"]) == (["adjacent(2, 3)"], [], [])


def test_a_doubtful_label_neither_asks_for_anything_nor_forbids_it():
    doubtful = [PairLabel(2, 3, "none", 1)]
    assert judge(doubtful, said(("on", 2, 3)))["wrong"] == []
    assert judge(doubtful, [])["expected"] == []
    # But a pair that the annotator did not list at all is not near.
    assert judge([], said(("on", 2, 3)))["wrong"] == ["on(2, 3)"]


def scene(name: str, *confidences: int) -> RealScene:
    truth = tuple(PairLabel(2 + k, TABLE, "on", confidence) for k, confidence in enumerate(confidences))
    return RealScene(name, LabelledCloud(np.zeros((1, 3)), np.ones(1, np.int64)), truth)


def test_the_scenes_with_most_sure_labels_ties_by_name():
    scenes = [scene("d", 1, 1, 1, 1), scene("c", 3, 2), scene("b", 2, 3, 1), scene("a", 3), scene("e", 3, 3, 3)]
    assert [one.name for one in most_labelled(scenes, 4)] == ["e", "b", "c", "a"]
    assert len(most_labelled([scene(str(k), 3) for k in range(26)])) == 10


def test_without_real_scenes_goals_stay_open_and_nothing_is_written(monkeypatch, tmp_path):
    monkeypatch.setattr(pictures, "real_scenes_folder", lambda: None)
    told = []
    result = bench_pictures(1, lambda *at: told.append(at), tmp_path / "pictures")
    assert result["rows"] == []
    assert [(goal["measured"], goal["met"]) for goal in result["goals"]] == [(None, None)] * 2
    assert not (tmp_path / "pictures").exists()
    assert told == []


def test_rows_goals_and_the_written_result_by_hand(monkeypatch, tmp_path):
    judged = {
        "one": {"pairs": 3, "expected": ["on(3, 2)"], "found": [], "missing": ["on(3, 2)"], "wrong": []},
        "two": {"pairs": 9, "expected": ["on(3, 2)"], "found": ["on(3, 2)"], "missing": [], "wrong": []},
    }
    monkeypatch.setattr(pictures, "real_scenes_folder", lambda: tmp_path)
    monkeypatch.setattr(pictures, "real_scenes", lambda: [scene("two", 3), scene("one", 3, 3)])
    monkeypatch.setattr(pictures, "draw_and_judge", lambda one, out: {"scene": one.name, **judged[one.name]})
    told = []
    result = bench_pictures(1, lambda *at: told.append(at), tmp_path)
    assert told == [(1, 2, "one"), (2, 2, "two")]
    values = {line["name"]: line["value"] for line in result["rows"]}
    assert (values["one, expected"], values["one, found"], values["one, missing"]) == (1, 0, 1)
    assert (values["all, expected"], values["all, found"], values["all, missing"], values["all, wrong"]) == (
        2,
        1,
        1,
        0,
    )
    missing, wrong = result["goals"]
    assert (missing["measured"], missing["met"], wrong["measured"], wrong["met"]) == (1, False, 0, True)
    assert "one: on(3, 2)" in missing["name"]
    assert "two" not in missing["name"]
    written = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))
    assert written["scenes"] == [{"scene": name, **judged[name]} for name in ("one", "two")]


@pytest.mark.skipif("LIFELORE_DATA" not in os.environ, reason="LIFELORE_DATA is not set")
def test_a_real_scene_is_drawn_in_a_palette_and_judged(tmp_path):
    from PIL import Image

    folder = real_scenes_folder()
    assert folder is not None
    truths = read_relations(folder / "relations.csv")
    name = min(truths, key=lambda one: (len(truths[one]), one))
    chosen = RealScene(name, to_scene(read_cloud(folder / f"{name}.pcd")), truths[name])
    found = draw_and_judge(chosen, tmp_path)
    assert list(found) == ["scene", "pairs", "expected", "found", "missing", "wrong"]
    assert found["scene"] == chosen.name
    sure = [label for label in chosen.truth if label.confidence >= 2]
    assert found["pairs"] == len(sure)
    assert len(found["expected"]) == sum(label.relation != "none" for label in sure)
    assert sorted([*found["found"], *found["missing"]]) == sorted(found["expected"])
    (path,) = tmp_path.iterdir()
    assert path.name == f"{chosen.name}.png"
    with Image.open(path) as picture:
        assert picture.format == "PNG"
        assert picture.mode == "P"
        assert min(picture.size) > 300
