"""Holes played with their luck, and numbers of groups by hand."""

import numpy as np
import pytest

from reproduction.chapter4.c4_02_golf_holes.run import readings, run_cell
from reproduction.chapter4.golf.rounds import exact_library, play_greedily

SMALL = {"groups": 3, "holes": 12, "yards": [220.0, 120.0], "shots": 3, "samples": [10], "pseudo_count": 0.5}


def test_holes_are_played_with_their_luck():
    luck = np.array([[0.0, 1.0], [0.0, -1.0]])
    generator = np.random.default_rng(0)
    found = play_greedily(exact_library(), np.array([150.0, 219.0]), luck, generator, first=2)
    assert found.error[:, 0].tolist() == [0.0, -69.0]
    # "Within 5" makes 150 yards likeliest, "short by > 50" 220: the 6-iron again, and the wood.
    assert found.clubs.tolist() == [[2, 2], [2, 0]]
    assert found.error[:, 1].tolist() == [6.0, 215 - 8 - 219]


def test_the_best_club_of_each_hole_is_no_worse_than_any_club_alone():
    found = run_cell({**SMALL, "holes": 400}, {"part": "clubs"}, 1)
    assert (np.array(found["best"]) < np.min(found["club"], axis=1)).all()


def test_numbers_by_hand():
    def greedy(first, errors):
        return {"samples": None, "first": first, "error": errors, "entropy": [[1.4, 0.2], [1.4, 0.4]]}

    results = [
        greedy(None, [[30.0, 10.0], [30.0, 12.0]]),
        greedy(0, [[50.0, 16.0], [50.0, 14.0]]),
        {"part": "clubs", "club": [[40.0, 26.0], [40.0, 28.0]], "best": [9.0, 9.0]},
    ]
    (_, free), (_, after_club_1) = readings(SMALL, results)
    values = {name: one.value for name, one in free.items()}
    assert values == pytest.approx({"error_shot_2": 11, "entropy_fall": 1.1, "gain_over_single_club": 16})
    assert after_club_1["error_shot_2"].value == 15
