"""C2.5: what is lost is a paired difference over scenes; displacements by method, on clouds made by hand."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.relations import PairLabel
from reproduction.chapter2.c2_05_discarded_points.run import (
    METHODS,
    THINNED,
    judged,
    measures,
    strong_places,
    view,
)
from reproduction.chapter2.scoring.relation_scoring import JudgedPair


def answer(right: bool, scene: str, truth: str = "on") -> JudgedPair:
    return JudgedPair(scene, PairLabel(2, 3, truth), right, 0.0)


def test_measures_by_hand():
    # Of five, three are on (two of them told) and two none (told): 4/5 - 3/5; whole, all are told.
    worst = [answer(number != 0, str(number)) for number in range(3)]
    worst += [answer(True, str(number), "none") for number in (3, 4)]
    whole = [answer(True, pair.scene, pair.truth.relation) for pair in worst]
    found = measures({0.0: whole, 0.3: whole, 0.7: worst})
    assert {name: number.value for name, number in found.items()} == pytest.approx(
        {"lost_30": 0, "lost_70": 0.2, "less_majority": 0.2}
    )


def test_contacts_of_seven_are_kept_and_are_weighted_centroids():
    seven = np.array([[0.001 * k, 0, 0] for k in range(7)])
    six = np.array([[0.1 + 0.001 * k, 0, 0] for k in range(6)])
    points, alpha = np.concatenate([seven, six]), np.array([1.0] * 6 + [3.0] + [9.0] * 6)
    # (0 + 1 + … + 5 + 3 · 6) / 9 = 33 / 9 mm; the six, though stronger by far, are too few.
    assert strong_places(points, alpha, 0.025) == pytest.approx(np.array([[33e-4 / 9 * 10, 0, 0]]), abs=1e-9)
    both = strong_places(points, alpha, 0.025, least=6)
    assert both[:, 0] == pytest.approx([0.1025, 33e-3 / 9])
    assert strong_places(points[7:], alpha[7:], 0.025).shape == (0, 3)


def plate(n: int, *corner: float, step: float = 0.004) -> np.ndarray:
    x, y = np.meshgrid(np.arange(n) * step, np.arange(n) * step)
    return np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1) + np.array(corner)


def plates(n: int, step: float) -> LabelledCloud:
    """Plates 2 and 3, 6 mm apart."""
    points = np.concatenate([plate(n, 0, 0, 0, step=step), plate(n, 0, 0, 0.006, step=step)])
    return LabelledCloud(points, np.repeat([2, 3], n * n))


def test_displacements_of_two_plates_lead_from_one_to_the_other():
    for method, pairs in view(plates(31, 0.002), 1.0).items():
        (found,) = pairs
        assert found[:3] == [2, 3, 0.006], method
        moved = np.array(found[3])
        assert moved[:, 2] == pytest.approx(-0.006, abs=1e-5)
        # One pair of contact points faces one another, whatever the number of contacts.
        assert np.hypot(*moved[:, :2].T).min() < 0.003


UP, ASIDE = [[0.0, 0.0, 0.01]] * 4, [[0.03, 0.0, 0.0]] * 4
"""Displacements χ_2 - χ_3: of 2 on 3, and of 2 beside 3; four each, as many as neighbours vote."""


def scene(name, truth, *views, gap=0.001):
    rows = [dict.fromkeys(METHODS, [[2, 3, gap, moved]] if moved else []) for moved in views]
    return {"name": name, "truth": [[2, 3, truth, 3]], "gaps": [[2, 3, gap]], "views": rows}


def test_pairs_are_told_by_the_lessons_and_those_on_the_border_left_out():
    lessons = [
        scene("one", "on", UP),
        scene("two", "adjacent", ASIDE),
        scene("three", "both", [[0.5, 0.5, 0.5]] * 4),
    ]
    scenes = [
        scene("a", "on", UP[:1], ASIDE[:1]),
        scene("b", "adjacent", ASIDE[:1], []),
        scene("c", "adjacent", ASIDE[:1], ASIDE[:1], gap=0.025),  # 2.5 mm from the limit of adjacent
        scene("d", "both", [UP[0], ASIDE[0]], UP[:1]),
    ]
    results = [{"kind": "lessons", "scenes": lessons}, {"kind": "scenes", "scenes": scenes}]
    found = judged({"discarded": [0.7]}, results)[THINNED]
    # Less is left: *on* looks like *adjacent*, *adjacent* like nothing, and *both* like *on*.
    assert {level: [(pair.scene, pair.exact) for pair in pairs] for level, pairs in found.items()} == {
        0.0: [("a", True), ("b", True), ("d", True)],
        0.7: [("a", False), ("b", False), ("d", False)],
    }
