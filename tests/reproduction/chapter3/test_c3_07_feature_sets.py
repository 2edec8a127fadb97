"""Measures of C3.7 from made-up cells, by hand, and the priors of a few small runs."""

from itertools import product

import numpy as np
import pytest

from lifelore.domains.factory.factory import RAW
from reproduction.chapter3.c3_07_feature_sets.measure import measure, rows
from reproduction.chapter3.c3_07_feature_sets.run import KEYS, METHODS, grid_of, run_cell
from reproduction.chapter3.factory.modified_tasks import (
    CARDINALS,
    DIAGONALS,
    contexts_of,
    learn_problem,
    problem_of,
)
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.7")
QUICK = dict(claim_of("C3.7").sizes["quick"])

SETTINGS = {
    **QUICK,
    "runs": 4,
    "episodes": 3,
    "early": 2,
    "encodings": ["global"],
    "schedules": [[1.0, 0.95, 0.01]],
    "alpha0": [0.1],
    "max_steps": [200],
    "policies": [3],
    "walls": [[2, 4]],
}
"""A grid of two cells, ties uniform and by the prior."""
AS_PRINTED = {
    "uniform": -5000.0,
    "state": -4000.0,
    "phi1": -3000.0,
    "phi2": -1100.0,
    "phi3": -1000.0,
    "phi4": -1500.0,
}
JITTER = [-3.0, 1.0, -1.0, 3.0]


def made_up(means=AS_PRINTED, by_prior=None):
    """Cells of four runs, every number a bit apart by run and method; `by_prior`: means where the prior ties."""

    def numbers(method, how, run):
        of_cell = by_prior if by_prior and how["ties"] == "prior" else means
        place = METHODS.index(method)
        value = of_cell[method] + JITTER[(run + place) % 4] * (1 + 0.1 * place)
        return {
            "method": method,
            **how,
            **dict.fromkeys(("early", "all"), value),
            "mean": [value] * 3,
        }

    met = [(method, cell) for method in METHODS for cell in grid_of(SETTINGS).cells_of(method)]
    return [
        {
            "run": run,
            "optimal": 0.0,
            "optimal_of_walls": [[-50.0, 50.0]],
            "found": [numbers(*at, run) for at in met],
        }
        for run in range(4)
    ]


def plain(measured):
    return {name: number.to_dict() for name, number in measured.items()}


def test_differences_by_hand():
    found = measure(SETTINGS, made_up())
    # The jitter cancels over the four runs.
    assert found["early_phi3"].value == pytest.approx(-1000)
    assert found["phi3_minus_phi1"].value == pytest.approx(2000)
    assert found["phi4_minus_phi3"].value == pytest.approx(-500)
    assert found["state_minus_uniform"].value == pytest.approx(1000)
    # The optimum lies 5000 above learning without a prior.
    assert found["phi2_minus_phi3_of_distance"].value == pytest.approx(-100 / 5000)
    assert rows(SETTINGS, made_up())[0]["closed_phi4"]["value"] == pytest.approx(3500 / 5000)
    assert found["phi3_minus_phi1"].n == 4
    # The tasks' optimal rewards are 50 below and above zero: their size is 50.
    assert found["phi2_minus_phi3_of_optimal"].value == pytest.approx(-100 / 50)


def in_other_cells(settings, changed):
    """Runs in a grid of more cells, each as at the default walls and code but for `changed(found)`."""
    cells = [(method, cell) for method in METHODS for cell in grid_of(settings).cells_of(method)]
    results = made_up()
    for result in results:
        by_ties = {(f["method"], f["ties"]): f for f in result["found"]}
        found = [{**by_ties[method, cell["ties"]], **cell, "method": method} for method, cell in cells]
        result["found"] = [{**one, **changed(one)} for one in found]
        result["optimal_of_walls"] = [[0.0], [-50.0, 50.0]]
    return results


def test_other_numbers_of_walls_join_the_second_grid_alone():
    settings = {**SETTINGS, "walls": [[1, 2], [2, 4]]}

    def changed(found):
        return {"all": -10.0} if found["walls"] == [1, 2] and found["method"] == "phi2" else {}

    found = measure(settings, in_other_cells(settings, changed))
    # Two cells, by ties, of each number of walls; in those with few φ2 is best.
    assert (found["grid_phi3_best"].value, found["grid_phi3_best"].n) == (1.0, 2)
    assert (found["walls_grid_phi3_best"].value, found["walls_grid_phi3_best"].n) == (0.5, 4)


def test_codes_of_states_count_where_states_are_compared_alone():
    settings = {**SETTINGS, "encodings": ["global", "left", "phase"], "walls": [[1, 2], [2, 4]]}

    def changed(found):
        return {"all": -9000.0} if found["encoding"] == "left" else {}

    found = measure(settings, in_other_cells(settings, changed))
    # Walls × ties, then two other codes; coded by the left, states earn less than no prior.
    order = found["walls_grid_features_above_state_above_uniform"]
    assert (order.value, order.n) == (pytest.approx(5 / 6), 6)
    assert found["walls_grid_phi3_best"].n == 4
    # The first reading counts a cell of the sets of features once for each code.
    assert found["grid_phi3_best"].n == 2 + 2


def test_the_grid_crosses_walls_schedules_and_ties():
    full = claim_of("C3.7").settings("full")
    grid = grid_of(full)
    crossed = list(product(full["walls"], full["schedules"], full["ties"]))
    assert [(cell["walls"], cell["schedule"], cell["ties"]) for cell in grid.cells[: len(crossed)]] == crossed
    assert len({grid.key(cell) for cell in grid.cells}) == len(grid.cells) == 3 * 2 * 2 + 3 + 1 + 1 + 1


def test_the_first_grid_is_the_part_with_the_default_walls():
    full = claim_of("C3.7").settings("full")
    grid, default = grid_of(full), full["default"]
    first = [cell for cell in grid.cells if cell["walls"] == default["walls"]]
    alone = {"encoding": ["left", "listed", "phase"], "alpha0": [1.0], "max_steps": [20000], "policies": [10]}
    assert first == [
        *({**default, "schedule": s, "ties": t} for s in full["schedules"] for t in full["ties"]),
        *({**default, key: value} for key, values in alone.items() for value in values),
    ]


def test_shares_of_the_grid_by_hand():
    assert measure(SETTINGS, made_up())["grid_phi3_best"].value == 1.0
    other = {**AS_PRINTED, "phi2": -900.0, "state": -5500.0}
    found = measure(SETTINGS, made_up(by_prior=other))
    assert found["grid_phi3_best"].value == found["grid_features_above_state_above_uniform"].value == 0.5


@pytest.mark.parametrize(
    ("changed", "verdict"),
    [
        ({}, "holds"),
        ({"phi4": -900.0}, "holds in part"),
        ({"phi2": -1400.0}, "holds in part"),
        ({"state": -6000.0}, "holds in part"),
        ({"state": -500.0, "uniform": -400.0}, "does not hold"),
    ],
)
def test_verdicts(changed, verdict):
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up({**AS_PRINTED, **changed})))) == verdict


def test_every_condition_asks_of_something_measured():
    assert CLAIM.read_measures() <= set(measure(SETTINGS, made_up()))


def test_the_figure_is_drawn_from_rows_alone():
    results = made_up()
    result = {"settings": SETTINGS, "measured": plain(measure(SETTINGS, results)), "rows": rows(SETTINGS, results)}
    curves, grid = CLAIM.draw(result).axes
    assert len(curves.lines) == len(METHODS) + 1
    assert [text.get_text() for text in grid.texts][:5] == ["20", "40", "78", "80", "70"]
    names = [label.get_text() for label in grid.get_yticklabels()]
    assert names == ["2 to 4 walls, ε 1 × 0.95, ties uniform", "2 to 4 walls, ε 1 × 0.95, ties prior"]


@pytest.fixture(scope="module")
def small():
    settings = {**QUICK, "episodes": 4, "early": 2, "test_tasks": 1, "max_steps": [50, 60]}
    settings["default"] = {**QUICK["default"], "max_steps": 60}
    return settings, run_cell(settings, {"run": 0}, 3)


def test_every_method_is_met_once_in_each_cell_it_reads(small):
    _, result = small
    met = [(f["method"], str([f[key] for key in KEYS])) for f in result["found"]]
    assert len(set(met)) == len(met)
    by_method = {method: sum(name == method for name, _ in met) for method in METHODS}
    # Walls × ε × ties, α⁰, cap, policies; states have three codings more; no prior has walls × ε and the cap.
    assert by_method == {"uniform": 7, "state": 18, **dict.fromkeys(("phi1", "phi2", "phi3", "phi4"), 15)}


def test_without_a_prior_it_is_plain_q_learning(small):
    settings, result = small
    problem = problem_of(settings, (3, "C3.7", 0, "testing", 0))
    schedule = schedule_of({**settings, "max_steps": 60}, [1.0, 0.95, 0.01])
    rewards = learn_problem(problem, None, schedule)[0].rewards
    default = next(
        f for f in result["found"] if f["method"] == "uniform" and "mean" in f and f["schedule"][0] == 1.0
    )
    np.testing.assert_allclose(default["mean"], rewards, atol=0.006)
    assert result["optimal"] == problem.optimal


def test_a_problem_is_solved_from_start_to_end():
    problem = problem_of({"discount": 0.99, "components": 2}, (5, "C3.7"))
    n_cells = problem.task.factory.n_cells
    assert problem.way[0] == problem.tables.starts[0] == problem.task.factory.start
    assert (problem.task.stages[problem.way[0] // n_cells] == RAW).all()
    # Two items procured and assembled pay 40 and completion 100; every other step of the way costs 2.
    assert problem.optimal == 140 - 2 * (len(problem.way) - 4)
    assert not problem.best[problem.task.completed].any()
    assert problem.best[~problem.task.completed].any(axis=1).all()
    # φ2 is four of the 3×3 cells, each of four kinds.
    assert contexts_of(problem, "phi2").max() < 4**4
    assert not set(CARDINALS) & set(DIAGONALS)
