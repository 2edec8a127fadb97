"""Every peer keeps the interface of `RelationClassifier`: it learns, infers direction, repeats, refuses."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.perception.relations.relation import Relation
from reproduction.own.o_07_unseen_scenes.peers import PEERS

LEARNT = [name for name in PEERS if name != "bounding-box rule"]
LEAST_RIGHT = {
    "bounding-box rule": 0.95,
    "orientation histogram": 0.85,
}


@pytest.fixture(scope="module")
def seen(lesson):
    """What each peer saw of the lesson."""
    clouds, _ = lesson
    return {name: [new().describe_pairs(cloud) for cloud in clouds] for name, new in PEERS.items()}


def fitted(name, seen, truths, kept=slice(None)):
    return PEERS[name]().fit_pairs(seen[name][kept], truths[kept])


def of_pair(relations, a, b) -> Relation:
    (found,) = [one for one in relations if {one.a, one.b} == {a, b}]
    return found


def same(label: PairLabel, relation: Relation) -> bool:
    ordered = (relation.a, relation.b) == (label.a, label.b)
    return relation.relation == label.relation and (ordered or label.relation in ("adjacent", "none"))


@pytest.mark.slow
@pytest.mark.parametrize("name", PEERS)
def test_what_it_learns_holds_on_scenes_it_has_not_seen(name, seen, lesson):
    _, truths = lesson
    model = fitted(name, seen, truths, slice(0, 27))
    right = [
        same(truth[0], of_pair(model.predict_pairs(scene), 2, 3))
        for scene, truth in zip(seen[name][27:], truths[27:], strict=True)
    ]
    assert np.mean(right) >= LEAST_RIGHT[name]


@pytest.mark.slow
@pytest.mark.parametrize("name", PEERS)
def test_names_of_the_objects_carry_nothing(name, seen, lesson):
    clouds, truths = lesson
    model = fitted(name, seen, truths)
    for cloud in clouds[:6]:
        turned = np.where(cloud.labels > TABLE, 5 - cloud.labels, cloud.labels)
        said = of_pair(model.predict(cloud), 2, 3)
        again = of_pair(model.predict(LabelledCloud(cloud.points, turned, None, cloud.camera)), 2, 3)
        assert again.relation == said.relation
        assert again.confidence == pytest.approx(said.confidence)
        if said.relation == "on":
            assert (again.a, again.b) == (said.b, said.a)


@pytest.mark.slow
@pytest.mark.parametrize("name", PEERS)
def test_a_relation_for_every_near_pair_with_confidence(name, seen, lesson):
    clouds, truths = lesson
    said = fitted(name, seen, truths).predict(clouds[0])
    assert {frozenset((one.a, one.b)) for one in said} == {frozenset(p) for p in ((2, 3), (2, 1), (3, 1))}
    assert all(0 < one.confidence <= 1 and one.gap >= 0 for one in said)


@pytest.mark.slow
@pytest.mark.parametrize("name", PEERS)
def test_the_same_lesson_gives_the_same_answers(name, seen, lesson):
    _, truths = lesson
    one, other = fitted(name, seen, truths), fitted(name, seen, truths)
    for scene in seen[name][:6]:
        assert one.predict_pairs(scene) == other.predict_pairs(scene)


@pytest.mark.slow
@pytest.mark.parametrize("name", PEERS)
def test_fit_is_looking_and_learning(name, seen, lesson):
    clouds, truths = lesson
    kept = slice(0, 6)
    assert PEERS[name]().fit(clouds[kept], truths[kept]).predict(clouds[7]) == fitted(
        name, seen, truths, kept
    ).predict_pairs(seen[name][7])


@pytest.mark.slow
@pytest.mark.parametrize("name", PEERS)
def test_a_scene_of_one_object_has_no_pair_of_objects(name, seen, lesson):
    clouds, truths = lesson
    model = fitted(name, seen, truths)
    kept = clouds[0].labels != 3
    alone = LabelledCloud(clouds[0].points[kept], clouds[0].labels[kept])
    assert [(one.a, one.b) for one in model.predict(alone)] == [(2, TABLE)]
    assert model.predict(LabelledCloud(np.zeros((0, 3)), np.zeros(0, np.int64))) == ()


@pytest.mark.parametrize("name", LEARNT)
def test_it_refuses_to_answer_before_it_has_learnt(name, lesson):
    with pytest.raises(InputError, match="must be fitted before it predicts"):
        PEERS[name]().predict(lesson[0][0])


@pytest.mark.slow
@pytest.mark.parametrize("name", LEARNT)
def test_it_refuses_lessons_that_do_not_fit(name, seen, lesson):
    _, truths = lesson
    with pytest.raises(InputError, match="one for each cloud, got 1 for 2"):
        PEERS[name]().fit_pairs(seen[name][:2], truths[:1])
    doubted = [(PairLabel(2, 3, "on", 1),)]
    with pytest.raises(InputError, match="label a near pair"):
        PEERS[name]().fit_pairs(seen[name][:1], doubted)


@pytest.mark.slow
@pytest.mark.parametrize("name", LEARNT)
def test_one_word_is_enough_to_learn(name, seen):
    said = PEERS[name]().fit_pairs(seen[name][:1], [(PairLabel(2, 3, "near"), PairLabel(3, 2, "near", 1))])
    assert of_pair(said.predict_pairs(seen[name][0]), 2, 3).relation == "near"


@pytest.mark.slow
@pytest.mark.parametrize("name", LEARNT)
def test_a_pair_with_two_relations_is_refused(name, seen):
    for other in (PairLabel(2, 3, "adjacent"), PairLabel(3, 2, "on")):
        with pytest.raises(InputError, match="one relation"):
            PEERS[name]().fit_pairs(seen[name][:1], [(PairLabel(2, 3, "on"), other)])
    twice = (PairLabel(2, 3, "adjacent"), PairLabel(3, 2, "adjacent"))
    said = PEERS[name]().fit_pairs(seen[name][:1], [twice]).predict_pairs(seen[name][0])
    assert of_pair(said, 2, 3).relation == "adjacent"
