"""Every peer learns what holds of unseen scenes, and the order of names carries nothing."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.perception.relations.relation import Relation
from reproduction.own.o_07_unseen_scenes.peers import PEERS
from reproduction.own.o_07_unseen_scenes.peers.described_pairs import described_pairs

LEAST_RIGHT = {"bounding-box rule": 0.95, "orientation histogram": 0.85}


@pytest.fixture(scope="module", params=PEERS)
def peer(request, lesson):
    """A peer's name, the peer that learnt the first 27 scenes of the lesson, and what it saw of the others."""
    clouds, truths = lesson
    new = PEERS[request.param]
    seen = [described_pairs(cloud, new.describe) for cloud in clouds]
    return request.param, new().fit(seen[:27], truths[:27]), seen[27:]


def of_pair(relations, a, b) -> Relation:
    (found,) = [one for one in relations if {one.a, one.b} == {a, b}]
    return found


def same(label: PairLabel, relation: Relation) -> bool:
    ordered = (relation.a, relation.b) == (label.a, label.b)
    return relation.relation == label.relation and (ordered or label.relation in ("adjacent", "none"))


@pytest.mark.slow
def test_what_it_learns_holds_on_scenes_it_has_not_seen(peer, lesson):
    name, model, others = peer
    right = [
        same(truth[0], of_pair(model.predict(scene), 2, 3))
        for scene, truth in zip(others, lesson[1][27:], strict=True)
    ]
    assert np.mean(right) >= LEAST_RIGHT[name]


@pytest.mark.slow
def test_names_of_the_objects_carry_nothing(peer, lesson):
    _, model, _ = peer

    def answers(cloud):
        return model.predict(described_pairs(cloud, model.describe))

    for cloud in lesson[0][:6]:
        turned = np.where(cloud.labels > TABLE, 5 - cloud.labels, cloud.labels)
        said = of_pair(answers(cloud), 2, 3)
        again = of_pair(answers(LabelledCloud(cloud.points, turned, None, cloud.camera)), 2, 3)
        assert again.relation == said.relation
        assert again.confidence == pytest.approx(said.confidence)
        if said.relation == "on":
            assert (again.a, again.b) == (said.b, said.a)
