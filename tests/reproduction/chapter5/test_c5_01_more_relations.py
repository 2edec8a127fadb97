"""C5.1: placements, truth by shapes, compound relations and counts by hand."""

from types import SimpleNamespace

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.domains.tabletop.pose import Pose
from lifelore.domains.tabletop.shapes import ball, box, cup
from reproduction.chapter5.c5_01_more_relations.run import (
    compound_counts,
    compound_facts,
    seen,
    true_compounds,
    word_counts,
)
from tests.perception.conftest import box_surface

CUBE = box(0.06, 0.06, 0.06)


def at(x: float, y: float, z: float = 0.03) -> Pose:
    return Pose(np.array([x, y, z]), np.eye(3))


def made(poses: list[Pose], truth: list[PairLabel], shapes=None) -> SimpleNamespace:
    """Cubes (or other shapes) where they are put, and what is true of them; the cubes' surfaces as the cloud."""
    parts = [box_surface(pose.position - 0.03, pose.position + 0.03, 0.004) for pose in poses]
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


def test_what_is_seen_of_a_row_of_two_by_hand():
    scene = made([at(-0.035, 0), at(0.035, 0)], [PairLabel(3, 2, "adjacent"), *ON_TABLE[:2]])
    # The camera looks along +y, so that right is +x.
    pairs, words = seen(scene)  # type: ignore[arg-type]
    assert [(label.a, label.b, label.relation) for label in words] == [(2, 3, "left_of"), (3, 2, "right_of")]
    assert pairs.features.pairs.tolist() == [[2, 3], [3, 2]]
    assert pairs.features.gaps == pytest.approx([0.01, 0.01], abs=1e-4)


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
    assert row["true"] == row["rule"] == [["between", 3, 2, 4]]
    # Two different adjacents, and not between: a counterexample.
    assert (angle["true"], angle["rule"]) == ([], [["between", 3, 2, 4]])
    leaning = made([at(0, 0), at(0.04, 0, 0.06)], [PairLabel(3, 2, "both"), *ON_TABLE[:2]])
    found = compound_facts(leaning)  # type: ignore[arg-type]
    assert (found["true"], found["rule"]) == ([], [["in", 3, 2]])


def test_between_needs_no_adjacent():
    """Erratum: the middle one of a row is between its neighbours without touching them, and the rule misses it."""
    none = [PairLabel(2, 3, "none"), PairLabel(4, 3, "none"), PairLabel(2, 4, "none")]
    apart = made([at(-0.09, 0), at(0, 0), at(0.09, 0)], [*ON_TABLE, *none])
    found = compound_facts(apart)  # type: ignore[arg-type]
    assert (found["true"], found["rule"]) == ([["between", 3, 2, 4]], [])


def test_a_word_is_counted_in_both_orders_of_every_labelled_pair():
    truth = [PairLabel(2, 3, "left_of"), PairLabel(3, 2, "right_of"), PairLabel(3, 4, "left_of")]
    truth += [PairLabel(4, 3, "right_of"), PairLabel(4, 3, "dwarfs")]
    found = word_counts(truth, {(2, 3, "left_of"), (4, 3, "left_of"), (5, 6, "left_of"), (4, 3, "dwarfs")})
    # Of left: (2, 3) right, (4, 3) wrong, (3, 4) missed; (5, 6) nobody labelled.
    assert found["left_of"] == [1, 2, 2]
    assert found["right_of"] == [0, 0, 2]
    assert found["dwarfs"] == [1, 1, 1]
    assert found["under"] == [0, 0, 0]


def test_facts_are_counted_by_kind_of_scene():
    row = {"kind": "row", "scenes": [{"true": [["between", 3, 2, 4]], "rule": []}] * 2}
    angle = {"kind": "angle", "scenes": [{"true": [], "rule": [["between", 3, 2, 4]]}]}
    assert compound_counts([row, angle], "between").tolist() == [[0, 0, 1], [0, 0, 1], [0, 1, 0]]
    assert compound_counts([row, angle], "in").tolist() == [[0, 0, 0]] * 3
