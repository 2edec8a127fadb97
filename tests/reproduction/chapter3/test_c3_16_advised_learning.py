"""Measures of C3.16 from made-up cells, by hand."""

import pytest

from reproduction.chapter3.c3_16_advised_learning.measure import measure, rows
from reproduction.engine.curve_blocks import block_edges
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.16")
QUICK = dict(claim_of("C3.16").sizes["quick"])

SETTINGS = {**QUICK, "tasks": 2, "episodes": 100, "schedules": [[1.0, 0.999, 0.05]]}
SETTINGS |= {"buildings": QUICK["buildings"][:2], "advised_alpha0": [0.1]}
N_BLOCKS = len(block_edges(100)) - 1


def tasks(firsts):
    return {
        "first": firsts,
        "ever": [first < 100 for first in firsts],
        "in_ten": [first <= 10 for first in firsts],
        "final": [800.0 if first < 100 else 0.0 for first in firsts],
    }


def made_up():
    """With advice from one start both goals are found within ten, in one maze; policies never help."""
    cells = []
    for maze in range(3):
        learners = []
        for starts in ("one", "any"):
            for experts in (None, "walks", "policies"):
                firsts = [100, 100] if starts == "one" else [5, 100]
                if experts == "walks":
                    firsts = [3, 10] if maze == 0 else [2, 40]
                curve = [100.0 * maze] * N_BLOCKS
                how = {"starts": starts, "schedule": [1.0, 0.999, 0.05], "experts": experts}
                learners.append({**how, **tasks(firsts), "curve": curve})
        cells.append({"loops": 0.1, "maze": maze, "learners": learners})
    return cells + [beside(place, maze) for place in range(2) for maze in range(3)]


def beside(place, maze):
    """Advice finds both goals in ten; with α⁰ 0.1 one of them; in the other building chance finds one too."""
    alone = [5, 100] if place else [100, 100]
    found = [{"alpha0": None, **tasks(alone)}, {"alpha0": 0.0, **tasks([3, 10])}]
    if place == 0:
        found.append({"alpha0": 0.1, **tasks([3, 11])})
    return {"building": place, "maze": maze, "beside": found}


def test_headline_by_hand():
    found = measure(SETTINGS, made_up())
    # 2, 1 and 1 of two tasks.
    assert found["found_in_ten_advised"].value == pytest.approx(4 / 6)
    assert found["found_in_ten_plain"].value == 0.0
    assert found["found_in_ten_gain"].value == pytest.approx(4 / 6)
    assert found["found_ever_advised"].value == 1.0
    assert found["final_gain"].value == 800.0
    assert found["final_gain"].ci95 == (800.0, 800.0)


def test_a_handful_is_one_only_where_chance_does_not_find_it_too():
    found = measure(SETTINGS, made_up())
    # Walks from one start: yes. From anywhere half the goals are found without advice: no. Policies: no.
    assert (found["grid_handful"].value, found["grid_handful"].n) == (0.25, 4)


def test_buildings_beside_the_default_by_hand():
    found = measure(SETTINGS, made_up())
    assert found["one_start_found_in_ten_advised"].value == 1.0
    assert found["one_start_found_in_ten_plain"].value == 0.0
    assert found["one_start_final_gain"].value == 800.0
    assert found["open_in_ten_plain"].value == 0.5
    # One of the grid's four cells; not half of the tasks with α⁰ 0.1, nor where chance finds them.
    assert (found["crossed_handful"].value, found["crossed_handful"].n) == (pytest.approx(1 / 6), 6)
    by_building = [row for row in rows(SETTINGS, made_up()) if "building" in row]
    assert [(row["alpha0"], row["in_ten"]) for row in by_building] == [
        (None, 0.0), (None, 0.5), (0.0, 1.0), (0.0, 1.0), (0.1, 0.5)
    ]  # fmt: skip


def test_rows_hold_the_grid_and_the_curves():
    found = rows(SETTINGS, made_up())
    grid = [row for row in found if "plain" in row]
    assert len(grid) == 2 * 2
    assert grid[0]["advised"] == {"in_ten": 0.667, "ever": 1.0, "final": 800.0, "median_first": 6.5}
    curves = [row for row in found if "curve_of" in row]
    assert [(c["curve_of"], c["starts"]) for c in curves] == [
        ("plain", "one"),
        ("advised", "one"),
        ("plain", "any"),
        ("advised", "any"),
    ]
    # 0, 100, 200: mean 100, standard deviation 100.
    assert curves[0]["mean"] == curves[0]["deviation"] == [100.0] * N_BLOCKS
