"""The verb from a folder of clouds to a model in memory and in a file."""

from dataclasses import replace

import numpy as np
import pytest

from lifelore.agent.perceive.learn_relations import LearnRelationsSettings, learn_relations
from lifelore.agent.perceive.relation_memory import (
    EXAMPLES,
    as_words,
    model_key,
    recall_model,
    recall_scenes,
    scenes_not_learnt,
)
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.protocols import Record
from lifelore.memory import open_memory
from lifelore.perception.relations.relation_classifier import RelationClassifier

PLACES = {"stack": (0.01, 0.01, 0.052), "near": (0.09, 0, 0), "far": (0.14, 0, 0)}
TRUTH = """scene,a,b,relation,confidence
stack,3,2,on,3
stack,2,1,on,3
stack,3,1,none,3
near,2,3,adjacent,3
far,2,3,none,2
"""


def surface(low, high, step=0.006) -> np.ndarray:
    axes = [np.linspace(a, b, max(2, round((b - a) / step) + 1)) for a, b in zip(low, high, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    return points[((points == np.array(low)) | (points == np.array(high))).any(axis=1)]


def cloud(place) -> LabelledCloud:
    parts = [surface((0, 0, 0), (0.08, 0.08, 0.05)), surface(place, np.add(place, (0.05, 0.05, 0.05)))]
    parts.append(surface((-0.1, -0.1, 0), (0.3, 0.2, 0)))
    return LabelledCloud(np.vstack(parts), np.repeat([2, 3, TABLE], [len(part) for part in parts]))


@pytest.fixture
def folder(tmp_path):
    for name, place in PLACES.items():
        one = cloud(place)
        np.savez(tmp_path / f"{name}.npz", points=one.points, labels=one.labels)
    (tmp_path / "truth.csv").write_text(TRUTH)
    return tmp_path


@pytest.mark.slow
def test_what_is_learnt_is_recalled_bit_for_bit_and_the_newest_wins(folder):
    lesson = LearnRelationsSettings(str(folder), str(folder / "truth.csv"), "kitchen")
    steps = []
    report = learn_relations(lesson, str(folder / "m.db"), str(folder / "m.npz"), lambda *step: steps.append(step))
    assert report["scenes"] == 3
    assert report["pairs"] == {"adjacent": 1, "none": 2, "on": 2}
    assert steps[-1][:2] == (3, 3)
    written = RelationClassifier.load(folder / "m.npz")
    with open_memory(folder / "m.db") as memory:
        recalled = recall_model(memory, "kitchen")
    one = cloud(PLACES["stack"])
    assert recalled.beliefs(one) == written.beliefs(one)
    assert {(r.a, r.b, r.relation) for r in recalled.predict(one)} >= {(3, 2, "on"), (2, TABLE, "on")}
    shorter = LearnRelationsSettings(str(folder), str(folder / "truth.csv"), "kitchen", method="displacement")
    learn_relations(shorter, str(folder / "m.db"))
    with open_memory(folder / "m.db") as memory:
        assert recall_model(memory, "kitchen").method == "displacement"
        with pytest.raises(NotFoundError, match="kitchen"):
            recall_model(memory, "cellar")


@pytest.mark.slow
def test_without_memory_a_file_alone_is_written(folder, monkeypatch):
    monkeypatch.setattr("lifelore.agent.perceive.learn_relations.open_memory", None)
    report = learn_relations(
        LearnRelationsSettings(str(folder), str(folder / "truth.csv")), out=str(folder / "m.npz")
    )
    assert report["memory"] is None
    assert (folder / "m.npz").is_file()


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("attic,2,3,on,3", "no attic.pcd"),
        ("../stack,2,3,on,3", "without folders"),
        ("stack,9,2,on,3", r"on\(9, 2\)"),
    ],
)
def test_a_truth_that_does_not_fit_the_clouds_is_refused(folder, row, said):
    (folder / "wrong.csv").write_text(f"scene,a,b,relation,confidence\n{row}\n")
    with pytest.raises(InputError, match=said):
        learn_relations(LearnRelationsSettings(str(folder), str(folder / "wrong.csv")), str(folder / "m.db"))


@pytest.mark.slow
def test_labels_of_things_far_apart_are_not_counted_as_learnt(folder):
    away = cloud((0.25, 0, 0))
    np.savez(folder / "away.npz", points=away.points, labels=away.labels)
    more = "away,2,3,none,3\naway,3,2,beyond,2\naway,2,1,on,1\n"
    (folder / "more.csv").write_text(TRUTH + more)
    report = learn_relations(
        LearnRelationsSettings(str(folder), str(folder / "more.csv")), out=str(folder / "m.npz")
    )
    assert report["pairs"] == {"adjacent": 1, "none": 2, "on": 2}
    assert report["not_near"] == {"beyond": 1, "none": 1}


@pytest.mark.slow
def test_clouds_in_millimetres_with_parts_and_no_table(folder):
    """What `perceive` reads by an option, this reads by the same option."""
    for name, place in PLACES.items():
        one = cloud(place)
        kept = one.labels != TABLE
        labels = np.where(one.labels == 2, 20, 31)[kept]
        labels[:40] = 21
        np.savez(folder / f"{name}.npz", points=1000 * one.points[kept], labels=labels)
    (folder / "truth.csv").write_text("\n".join(row for row in TRUTH.splitlines() if ",1," not in row))
    (folder / "planes.csv").write_text("scene,nx,ny,nz,d\nstack,1,0,0,0\n")
    told = []
    fits = {"units": "mm", "up": (0, 0, 1), "labels": "parts"}
    lesson = LearnRelationsSettings(str(folder), str(folder / "truth.csv"), **fits)
    assert learn_relations(lesson, out=str(folder / "m.npz"), notice=told.append)["pairs"]["on"] == 1
    assert told == []
    model = RelationClassifier.load(folder / "m.npz")
    assert {(r.a, r.b, r.relation) for r in model.predict(cloud(PLACES["stack"]))} >= {(3, 2, "on")}
    learn_relations(replace(lesson, labels="auto"), out=str(folder / "m.npz"), notice=told.append)
    assert len(told) == 1
    assert "labels of 3 of 3 clouds were taken as parts" in told[0]
    for change, said in (
        ({"units": "m"}, "looks like cm: .* m in mm"),
        ({"up": None}, "scene 'near': no table was found"),
        ({"labels": "plain"}, "names an object that the cloud does not have; it has 20, 21, 31"),
    ):
        with pytest.raises(InputError, match=said):
            learn_relations(replace(lesson, **change), out=str(folder / "m.npz"))


def test_what_perceive_could_not_name_is_refused(folder):
    with pytest.raises(InputError, match=r"name must not end in \.npz"):
        LearnRelationsSettings(str(folder), str(folder / "truth.csv"), "m.npz")
    with pytest.raises(InputError, match=r"out must end in \.npz"):
        learn_relations(LearnRelationsSettings(str(folder), str(folder / "truth.csv")), out=str(folder / "m.foo"))


def test_a_place_that_cannot_be_written_is_refused_before_the_work(folder):
    lesson = LearnRelationsSettings(str(folder), str(folder / "truth.csv"))
    (folder / "d.npz").mkdir()
    for out in (folder / "d.npz", folder / "none" / "m.npz"):
        with pytest.raises(InputError, match="out must be a file"):
            learn_relations(lesson, out=str(out), progress=lambda *step: pytest.fail("worked"))


def lesson(folder, scenes: str, file: str, **more) -> LearnRelationsSettings:
    (folder / file).write_text("scene,a,b,relation,confidence\n" + scenes)
    return LearnRelationsSettings(str(folder), str(folder / file), "kitchen", **more)


@pytest.mark.slow
def test_lessons_of_one_name_add_up_and_robots_share_them(folder):
    """Two robots learn a part each; their merged memory learns what one robot with all scenes learns."""
    first = lesson(folder, "stack,3,2,on,3\nstack,2,1,on,3\nstack,3,1,none,3\n", "first.csv")
    second = lesson(folder, "near,2,3,adjacent,3\nfar,2,3,none,2\n", "second.csv")
    both = lesson(folder, TRUTH.partition("\n")[2], "both.csv")
    assert learn_relations(first, str(folder / "rosie.db"))["remembered"] == 0
    learn_relations(second, str(folder / "karl.db"))
    learn_relations(both, str(folder / "alone.db"))
    with open_memory(folder / "rosie.db") as memory:
        memory.merge_many([str(folder / "karl.db")])
        assert scenes_not_learnt(memory, "kitchen") == 1  # the newest model, karl's, knows two of the three
        assert len(recall_scenes(memory, "kitchen")) == 3
    report = learn_relations(LearnRelationsSettings(name="kitchen"), str(folder / "rosie.db"))
    assert (report["scenes"], report["remembered"]) == (3, 3)
    assert report["pairs"] == {"adjacent": 1, "none": 2, "on": 2}
    one = cloud(PLACES["stack"])
    with open_memory(folder / "rosie.db") as fleet, open_memory(folder / "alone.db") as alone:
        assert scenes_not_learnt(fleet, "kitchen") == 0
        found = [(scene.digest, scene.truth) for scene in recall_scenes(fleet, "kitchen")]
        assert found == [(scene.digest, scene.truth) for scene in recall_scenes(alone, "kitchen")]
        assert {r.relation for r in recall_model(fleet, "kitchen").predict(one)} >= {"on", "none"}


@pytest.mark.slow
def test_a_scene_that_is_labelled_again_replaces_its_labels_and_anew_leaves_the_others_out(folder):
    place = str(folder / "m.db")
    learn_relations(lesson(folder, TRUTH.partition("\n")[2], "first.csv"), place)
    again = lesson(folder, "near,2,3,touching,3\n", "again.csv")
    report = learn_relations(again, place)
    assert (report["scenes"], report["remembered"]) == (3, 2)
    assert report["relations"] == ["none", "on", "touching"]
    with open_memory(place) as memory:
        said = {label.relation for scene in recall_scenes(memory, "kitchen") for label in scene.truth}
    assert said == {"none", "on", "touching"}
    alone = learn_relations(replace(again, anew=True), place)
    assert (alone["scenes"], alone["remembered"], alone["relations"]) == (1, 0, ["touching"])


def test_there_must_be_something_to_learn_from(folder):
    with pytest.raises(InputError, match="folder and truth belong together"):
        LearnRelationsSettings(str(folder))
    with pytest.raises(InputError, match="anew"):
        LearnRelationsSettings(anew=True)
    with pytest.raises(InputError, match="no scenes of 'attic'"):
        learn_relations(LearnRelationsSettings(name="attic"), str(folder / "m.db"))
    with pytest.raises(InputError, match="where no memory is opened"):
        learn_relations(LearnRelationsSettings(), out=str(folder / "m.npz"))


def test_a_damaged_scene_is_refused_in_one_line(folder):
    place = str(folder / "m.db")
    with open_memory(place) as memory:
        words = as_words(b"not a scene")
        record = Record(EXAMPLES, f"{model_key('kitchen')}/0", 1, "newest", np.arange(len(words)), words)
        memory.contribute("relations", [record], process="p", seq=0, task={})
    with pytest.raises(InputError, match="a labelled scene of 'kitchen' in memory is no labelled scene"):
        learn_relations(LearnRelationsSettings(name="kitchen"), place)
