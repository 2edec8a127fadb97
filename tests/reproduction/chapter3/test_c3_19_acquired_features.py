"""Measures of C3.19 from made-up runs, by hand; doubt by hand; and one small run."""

import numpy as np
import pytest

from reproduction.chapter3.c3_19_acquired_features.measure import measure, rows
from reproduction.chapter3.c3_19_acquired_features.run import (
    ACQUIRED,
    ALL,
    PLAIN,
    POOL,
    START,
    STARTS,
    counted_task,
    doubt,
    grid_of,
    run_cell,
)
from reproduction.engine.grid import run_grid
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.19")
SETTINGS = dict(claim_of("C3.19").sizes["quick"])
REWARDS = {PLAIN: 0.0, START: 10.0, ACQUIRED: 30.0, ALL: 32.0}
ENTROPY = {START: 2.0, ACQUIRED: 1.2, ALL: 1.0}
FOUR = ["PosUM", "PosML", "PosMR", "PosDM"]


def made_up(gains=(0, 1, -1, 2), kept=(*FOUR,)):
    """Runs whose acquired rewards differ by `gains`; all agents end with `kept` and Items."""
    grid = grid_of(SETTINGS)
    results = []
    for run, gain in enumerate(gains):

        def numbers(method, choice, gain=gain):
            reward = REWARDS[method] + gain * (method == ACQUIRED)
            found = {"all": reward, "mean": [reward] * 3}
            if method != PLAIN:
                doubt_here = ENTROPY[method] - gain / 10 * (method == ACQUIRED)
                found |= {"entropy": doubt_here, "surprise": doubt_here}
            return found | ({"features": [*kept, "Items"], "trials": 10} if method == ACQUIRED else {})

        found = list(run_grid(grid, "method", PLAIN, (START, ACQUIRED, ALL), numbers))
        results.append({"run": run, "optimal": 100.0, "found": found})
    return results


def plain(measured):
    return {name: number.to_dict() for name, number in measured.items()}


def test_measures_by_hand():
    found = measure(SETTINGS, made_up())
    assert found["reward_acquired_minus_start"].value == pytest.approx(20.5)
    assert found["entropy_start_minus_acquired"].value == pytest.approx(0.85)
    assert found["acquired_minus_all_of_gain"].value == pytest.approx(-1.5 / 100)
    assert found["least_share_of_four"].value == 1.0
    assert found["largest_share_of_noise"].value == 0.0
    assert found["grid_falls_and_faster"].value == 1.0
    assert measure(SETTINGS, made_up(kept=("PosUM", "Noise2")))["largest_share_of_noise"].value == 1.0
    assert {c.measure for c in CLAIM.predicate.conditions} <= set(found)


def test_rows_name_what_is_known_from_the_start():
    found = rows(SETTINGS, made_up())
    cells = [row for row in found if "shares" in row]
    assert len(cells) == len(SETTINGS["starts"]) * len(SETTINGS["leasts"])
    for row in cells:
        assert {name for name, share in row["shares"].items() if share is None} == set(STARTS[row["start"]])
    assert [row["curve_of"] for row in found[len(cells) :]] == [PLAIN, START, ACQUIRED, ALL]


def test_verdicts():
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up()))) == "holds"
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up(kept=FOUR[:3])))) == "holds in part"
    slower = made_up(gains=(-30, -29, -31, -28))
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, slower))) == "does not hold"


def test_doubt_by_hand():
    probs = np.array([[0.5, 0.5], [0.25, 0.75], [0.1, 0.9]])
    best = np.array([[True, True], [True, False], [False, False]])
    h = 0.25 * 2 - 0.75 * np.log2(0.75)
    assert doubt(probs, best) == pytest.approx(((1 + h) / 2, (1 + 2) / 2))


def test_noise_is_independent_of_the_state():
    task = counted_task(SETTINGS, (0, "test", 1))
    columns = POOL.columns(task.codes)
    assert np.array_equal(columns[:, :10], task.problem.seen)
    # About 1,000 states or more, four values each: within five standard deviations of a quarter.
    share = (columns[:, 10] == 2).mean()
    assert abs(share - 0.25) < 5 * (0.25 * 0.75 / len(columns)) ** 0.5


@pytest.mark.slow
def test_a_small_run_repeats_itself():
    small = {**SETTINGS, "starts": ["phi1"], "leasts": [0.1], "tasks": 4}
    first, second = (run_cell(small, {"run": 0}, 3) for _ in range(2))
    assert first == second
    (acquired,) = [found for found in first["found"] if found["method"] == ACQUIRED]
    assert set(STARTS["phi1"]) <= set(acquired["features"])
    assert acquired["trials"] == 1
