"""C2.8: which cuts are made, what is said of parts, and the numbers by hand."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import PairLabel
from lifelore.perception.relations.relation import Relation
from reproduction.chapter2.c2_08_oversegmented_object.run import free_standing, measure, relation_in_words

pytest.importorskip("mujoco")


def test_things_that_stand_by_themselves():
    truth = (
        PairLabel(2, TABLE, "on"),
        PairLabel(3, TABLE, "on"),
        PairLabel(4, TABLE, "none"),
        PairLabel(5, TABLE, "on", 2),
        PairLabel(3, 2, "both"),
        PairLabel(4, 2, "on"),
        PairLabel(5, 2, "adjacent"),
    )
    assert free_standing(truth) == [2]


@pytest.mark.parametrize(
    ("relation", "said"),
    [
        (Relation(7, 2, "on", 1.0, 0.0), "on"),
        (Relation(2, 7, "on", 1.0, 0.0), "on, turned"),
        (Relation(2, 7, "adjacent", 1.0, 0.0), "adjacent"),
        (Relation(2, 7, "both", 1.0, 0.0), "both, turned"),
        (Relation(2, 3, "on", 1.0, 0.0), "none"),
    ],
)
def test_what_is_said_has_a_direction(relation, said):
    assert relation_in_words((relation,), 7, 2) == said


def row(scene, kind, said):
    return {"scene": scene, "kind": kind, "said": said}


ROWS = [
    row("a", "level", "on"),
    row("a", "upright", "adjacent"),
    row("b", "level", "on, turned"),
    row("b", "upright", "on"),
    row("c", "level", "on"),
]


def test_measures_by_hand():
    found = measure({}, [{"real": False, "rows": ROWS, "examples": []}])
    assert found["on_right_simulated"].value == pytest.approx(2 / 3)
    assert found["adjacent_right_simulated"].value == 0.5
    assert np.isnan(found["on_right_real"].value)
