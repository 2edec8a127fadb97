"""O7: which pairs count, and gains by hand."""

from types import SimpleNamespace

import pytest

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT_GAP, PairLabel
from lifelore.perception.relations.relation import Relation
from reproduction.own.o_07_unseen_scenes.run import HISTOGRAM, METHODS, OURS, RULE, counts_of, measure


def test_pairs_with_the_table_and_near_the_limit_do_not_count():
    truth = (
        PairLabel(3, 2, "on"),
        PairLabel(2, TABLE, "on"),
        PairLabel(4, 2, "adjacent"),
        PairLabel(5, 2, "adjacent"),
    )
    gaps = [SimpleNamespace(a=a, b=2, visible=gap) for a, gap in ((3, 0.0), (4, ADJACENT_GAP - 0.001), (5, 0.0))]
    scene = SimpleNamespace(name="by hand", truth=truth, gaps=gaps)
    said = [Relation(2, 3, "on", 0.9, 0.0), Relation(2, 5, "adjacent", 0.9, 0.0)]
    # The direction of *on* is wrong; *adjacent* has none.
    assert counts_of(scene, said) == (1, 2)  # type: ignore[arg-type]


def test_gains_by_hand():
    right = {name: [3, 0, 4] for name in METHODS} | {OURS: [4, 0, 5], HISTOGRAM: [4, 0, 6], RULE: [0, 0, 0]}
    found = measure({}, [{"asked": [4, 0, 6], "right": right}])
    assert found["exact_contacts"].value == pytest.approx(0.9)
    assert found["more_than_thesis"].value == pytest.approx(0.2)
    assert found["more_than_histogram"].value == pytest.approx(-0.1)
    assert found["more_than_rule"].value == pytest.approx(0.9)
