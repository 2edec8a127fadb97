"""C5.2: roles are what they are called, shape tells nothing by construction, and the ranking by hand."""

from collections import Counter

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.perception.relations.relation import Relation
from lifelore.perception.scene import Scene
from reproduction.chapter5.c5_02_functional_roles.run import judged_queries, predicate_bag

pytest.importorskip("mujoco")


def test_predicates_of_a_middle_by_hand():
    cloud = LabelledCloud(np.eye(3), np.array([2, 3, 4]))
    said = [Relation(3, 2, "on", 1.0, 0.0), Relation(4, 3, "on", 1.0, 0.0), Relation(2, 4, "none", 1.0, 0.0)]
    scene = Scene(cloud, (), (*said, Relation(3, TABLE, "none", 1.0, 0.0)))
    assert predicate_bag(scene, 3) == Counter({("on", "first", "thing"): 1, ("on", "second", "thing"): 1})


def thing(scene, role, token, shape):
    bag = {token: 1}
    return {"scene": scene, "role": role, "topology": bag, "predicates": bag, "shape": shape}


def test_queries_by_hand():
    first = [thing("f0", "top", "up", [1.0, 0.0]), thing("f1", "base", "down", [0.0, 1.0])]
    second = [thing("s0", "top", "up", [0.0, 1.0]), thing("s1", "base", "down", [1.0, 0.0])]
    results = [{"pool": "first", "things": first}, {"pool": "second", "things": second}]
    queries = judged_queries(results)
    assert [query["scene"] for query in queries] == ["f0", "f1", "s0", "s1"]
    assert all(query["topology"] == 1.0 for query in queries)
    assert all(query["shape"] == 0.5 for query in queries)
    # One of two by chance: first or second, (1 + 1/2) / 2.
    assert all(query["chance"] == 0.75 for query in queries)
