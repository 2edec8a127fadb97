"""Claim C3.2: measures and figure from made-up cells by hand; cells of the grid do not disturb one another."""

import json

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.planning.planning import best_actions
from reproduction.chapter3.c3_02_lattice_prior.measure import measure, rows
from reproduction.chapter3.c3_02_lattice_prior.run import (
    PLAIN,
    annealed,
    cells,
    configurations,
    crossed_choices,
    online_priors,
    run_cell,
    run_of,
    without_ties,
)
from reproduction.chapter3.learning.grid_tasks import learn_task, rows_of
from reproduction.chapter3.learning.schedules import schedule_in_words, schedule_of, with_learning_rate
from reproduction.engine.curve_blocks import block_edges
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.2")
QUICK = dict(claim_of("C3.2").sizes["quick"])
SETTINGS = {
    **QUICK,
    "runs": 4,
    "schedules": [[1.0, 0.98, 0.01]],
    "forms": ["proportion", "support"],
    "alpha0": [0.1],
    "online_tasks": [0, 5],
}
"""A grid of four cells: proportion and support, ties uniform and by the prior."""


def made_up(first_of, to_80_of):
    """Cells of four runs; the functions give a configuration's number in a run, Q-learning -40 and 100."""
    n_blocks = len(block_edges(SETTINGS["episodes"])) - 1

    def method(how, first, to_80):
        numbers = {
            "first": first,
            "first_ten": first,
            "to_50": to_80 // 2,
            "to_80": to_80,
            "never_80": to_80 >= 120,
        }
        return {**how, **numbers, "never_50": False, "final": 0.9, "curve": [first] * n_blocks}

    found = []
    for run in range(4):
        methods = [method(PLAIN, -40.0 + run, 100 + run)]
        methods += [method(how, first_of(how, run), to_80_of(how, run)) for how in configurations(SETTINGS)]
        found.append(
            {"kind": "grid", "schedule": [1.0, 0.98, 0.01], "run": run, "optimal": 50.0, "methods": methods}
        )
    for run in range(4):
        first_ten = {"exact_0": -60.0, "learnt_0": -60.0, "exact_5": 2.0 + run, "learnt_5": 1.0 + run}
        found.append(
            {"kind": "online", "run": run, "optimal": 50.0, "plain": -60.0, "same": True, "first_ten": first_ten}
        )
    for run in range(4):
        choices = crossed_choices(SETTINGS) if run < SETTINGS["crossed_runs"] else [annealed(SETTINGS)]
        met = {str(one): one for one in (*map(without_ties, choices), *choices)}.values()
        methods = [{**one, **_of_choice(one, run)} for one in met]
        found.append({"kind": "crossed", "run": run, "optimal": 50.0, "methods": methods})
    return found


def _of_choice(choice, run):
    """With the prior all returns are positive; only where α is annealed is it faster."""
    ties, fast = choice["ties"], choice["learning_rate"][1] < 1
    numbers = {"first": -40.0, "to_80": 100} if ties is None else {"first": 2.0, "to_80": 50 if fast else 150}
    return {key: number + run for key, number in numbers.items()} | {"final": 0.9}


def by_ties(how, run):
    return (5.0 if how["ties"] == "prior" else -5.0) + 0.1 * run


def slower_for_proportion(how, run):
    return (110 if how["form"] == "proportion" else 50) + run


def test_headline_and_grid_shares_by_hand():
    found = measure(SETTINGS, made_up(by_ties, slower_for_proportion))
    assert found["first_eps_qsap"].value == pytest.approx(-5 + 0.15)
    assert found["to_80_ratio"].value == pytest.approx(111.5 / 101.5)
    assert found["grid_positive_at_once"].value == 0.5
    assert found["grid_faster_to_80"].value == 0.5
    assert found["grid_both"].value == 0.25
    assert found["grid_both"].n == 4
    assert found["optimal_return"].value == 50.0


def test_choices_of_learning_by_hand():
    # Two caps × two kinds of α × two of ties under one ε, without the two that the grid has.
    assert len(crossed_choices(SETTINGS)) == 8 - 2
    assert annealed(SETTINGS) in crossed_choices(SETTINGS)
    found = measure(SETTINGS, made_up(by_ties, slower_for_proportion))
    assert found["annealed_first_eps_qsap"].value == pytest.approx(3.5)
    assert found["annealed_first_eps_qsap"].n == 4  # all runs, not those of the other choices alone
    assert found["annealed_to_80_ratio"].value == pytest.approx(51.5 / 101.5)
    assert found["crossed_positive_at_once"].value == pytest.approx((2 + 6) / 10)
    assert found["crossed_faster_to_80"].value == pytest.approx((2 + 4) / 10)
    assert found["crossed_both"].value == pytest.approx((1 + 4) / 10)


def test_a_choice_of_learning_is_learnt_with_its_own_rate_and_cap():
    choice = annealed(SMALL)
    found = run_cell({**SMALL, "crossed_runs": 0}, {"kind": "crossed", "run": 0}, 0)["methods"]
    assert [m["ties"] for m in found] == [None, "uniform"]
    run = run_of(SMALL, 0, 0)
    schedule = schedule_of(SMALL, choice["schedule"])
    np.testing.assert_allclose(with_learning_rate(schedule, [0.5, 0.5, 0.2]).alpha[:4], [0.5, 0.25, 0.2, 0.2])
    schedule = with_learning_rate(schedule, choice["learning_rate"])
    first = [learn_task(problem, None, schedule)[0][:10].mean() for problem in run.testing]
    assert found[0]["first_ten"] == pytest.approx(np.mean(first))


def test_online_measures_by_hand():
    found = measure(SETTINGS, made_up(by_ties, slower_for_proportion))
    assert found["online_gain_after_0_learnt"].value == 0.0
    assert found["online_gain_after_5_learnt"].value == pytest.approx(62.5)
    assert found["online_gain_after_5_exact"].value == pytest.approx(63.5)
    assert found["online_minus_exact_of_optimal"].value == pytest.approx(-1 / 50)
    assert found["q_learning_is_uniform_prior"].value == 1.0


def test_rows_hold_the_whole_grid_and_its_curves():
    found = rows(SETTINGS, made_up(by_ties, slower_for_proportion))
    grid = [row for row in found if "to_80_ratio" in row]
    assert len(grid) == 5 + len(crossed_choices(SETTINGS))
    assert grid[0]["form"] is None
    assert grid[0]["to_80_ratio"]["value"] == 1.0
    curves = [row for row in found if "curve_of" in row]
    assert [row["curve_of"]["ties"] for row in curves] == [None, "uniform", "prior"]
    # Q-learning's curve is -40, -39, -38, -37: mean -38.5, standard error 1.2910/2, t(3) = 3.1824.
    np.testing.assert_allclose(curves[0]["mean"], -38.5)
    np.testing.assert_allclose(curves[0]["high"], -38.5 + 3.18245 * 1.29099 / 2, rtol=1e-5)


@pytest.mark.parametrize(
    ("overrides", "rule"),
    [
        ({"training_tasks": 7}, "online_tasks must contain 0 and training_tasks"),
        ({"caps": [100]}, "caps contain max_steps"),
        ({"size": 8}, "size of a lattice must be odd"),
        ({"test_tasks": 4000}, "test_tasks must be at most the 40 cells"),
        ({"online_tasks": [0, 5, 4000]}, "online_tasks must be at most"),
    ],
)
def test_settings_that_cannot_be_run(overrides, rule):
    with pytest.raises(InputError, match=rule):
        CLAIM.settings("quick", overrides)


FULL = dict(claim_of("C3.2").sizes["full"])
SMALL = {**QUICK, "episodes": 30, "runs": 1, "test_tasks": 2, "window": 5, "last": 5}


def test_the_grid_crosses_ties_form_and_pseudo_count_where_the_form_reads_it():
    found = configurations(FULL)
    assert len(found) == 2 * (2 * 3 + 2)
    assert {c["alpha0"] for c in found if c["form"] in ("support", "softmax")} == {None}
    assert {(c["form"], c["alpha0"]) for c in found if c["alpha0"]} == {
        (form, alpha0) for form in ("proportion", "dirichlet") for alpha0 in (0.01, 0.1, 1.0)
    }


def test_cells_are_runs_by_schedule_and_an_online_series_each():
    found = cells({**FULL, "runs": 2})
    assert [c["kind"] for c in found].count("grid") == 6
    assert [c["run"] for c in found if c["kind"] == "online"] == [0, 1]
    assert [c["run"] for c in found if c["kind"] == "crossed"] == [0, 1]


@pytest.fixture(scope="module")
def grid():
    return run_cell(SMALL, {"kind": "grid", "schedule": [1.0, 0.98, 0.01], "run": 0}, 0)


def test_a_cell_is_plain_data_with_every_configuration(grid):
    assert json.loads(json.dumps(grid)) == grid
    named = [{key: m[key] for key in PLAIN} for m in grid["methods"]]
    assert named == [PLAIN, *configurations(SMALL)]


def test_curves_are_kept_for_the_headline_alone(grid):
    kept = {(m["ties"], m["alpha0"], m["form"]) for m in grid["methods"] if "curve" in m}
    assert kept == {(None, None, None), ("uniform", 0.1, "proportion"), ("prior", 0.1, "proportion")}


def test_leaving_out_configurations_moves_no_other(grid):
    fewer = {**SMALL, "forms": ["dirichlet"], "alpha0": [1.0]}
    alone = run_cell(fewer, {"kind": "grid", "schedule": [1.0, 0.98, 0.01], "run": 0}, 0)
    numbers = {json.dumps({k: m[k] for k in PLAIN}): m["first_ten"] for m in grid["methods"]}
    for m in alone["methods"]:
        assert m["first_ten"] == numbers[json.dumps({k: m[k] for k in PLAIN})]


def test_online_series_starts_from_nothing_and_counts_the_learners_own_policies():
    found = run_cell(SMALL, {"kind": "online", "run": 0}, 0)
    assert found["first_ten"]["learnt_0"] == found["first_ten"]["exact_0"] == found["plain"]
    assert found["same"] is True
    assert set(found["first_ten"]) == {f"{s}_{n}" for s in ("exact", "learnt") for n in (0, 1, 5)}


def test_online_prior_after_one_task_by_hand():
    run = run_of(SMALL, 0, 0)
    schedule = schedule_of(SMALL, [1.0, 0.98, 0.01])
    priors = online_priors(run, SMALL, schedule)
    assert [len(priors[0]), len(priors)] == [0, 6]
    rows = rows_of(run.training[0], priors[0], "proportion", "uniform")
    q = learn_task(run.training[0], rows, schedule)[1].q
    expected = np.where(q.max(axis=1, keepdims=True) > 0, best_actions(q), False)
    assert (priors[1].counts(np.arange(len(q))) == expected).all()
    assert not priors[1].counts([run.training[0].goal]).any()


SCHEDULES = [[0.1, 1.0, 0.1], [1.0, 0.98, 0.01]]
HOWS = [(None, None, None), ("uniform", 0.1, "proportion"), ("prior", 0.1, "proportion")]


def number(value):
    return {"value": value, "median": value, "ci95": [value - 1, value + 1], "n": 3}


def result():
    rows = []
    for place, schedule in enumerate(SCHEDULES):
        for more, (ties, alpha0, form) in enumerate(HOWS):
            how = {"ties": ties, "alpha0": alpha0, "form": form}
            first = number(10.0 * place + more)
            numbers = {"first": first, "to_80": number(50.0), "to_80_ratio": number(1.5)}
            rows.append({"schedule": schedule, **how, **numbers, "to_50": number(40.0)})
            if ties:
                other = {"schedule": schedule, "ties": ties, "learning_rate": [0.5, 0.9, 0.1], "max_steps": 70}
                rows.append({**other, **numbers, "first": number(7.0)})
            rows.append({"curve_of": how, "schedule": schedule, "mean": [0, 1], "low": [0, 0], "high": [1, 2]})
    rows.append({"curve_edges": [0, 1, 60]})
    default = {"ties": "uniform", "schedule": SCHEDULES[0], "alpha0": 0.1, "form": "proportion"}
    settings = {
        "schedules": SCHEDULES,
        "ties": ["uniform", "prior"],
        "default": default,
        "episodes": 60,
        "runs": 3,
        "crossed_runs": 3,
        "max_steps": 60,
    }
    return {"rows": rows, "settings": settings, "measured": {"optimal_return": number(54.0)}}


def test_every_number_has_its_place():
    figure = CLAIM.draw(result())
    *schedules, first, ratio = figure.axes
    assert len(schedules) == 4
    assert [text.get_text() for text in first.texts] == ["+1.0", "+2.0", "+11.0", "+12.0"] + ["+7.0"] * 4
    assert [text.get_text() for text in ratio.texts] == ["1.50"] * 8
    # ±1 around 1 and 2 does not leave 0 for certain; around 11 and 12 it does.
    assert [text.get_fontweight() for text in first.texts] == ["normal"] + ["bold"] * 7
    assert [tick.get_text() for tick in first.get_yticklabels()] == ["proportion, α⁰ 0.1", "cap 70, α annealed"]


def test_the_cells_that_the_verdict_reads_are_framed_and_have_all_runs():
    drawn = result()
    annealed = ("annealed_first_eps_qsap", "annealed_to_80_ratio")
    drawn["measured"] |= dict(zip(annealed, map(number, (9.0, 1.2)), strict=True))
    drawn["rows"] = [{**row, "max_steps": 60} if "learning_rate" in row else row for row in drawn["rows"]]
    *_, first, ratio = CLAIM.draw(drawn).axes
    assert [text.get_text() for text in first.texts][4:] == ["+9.0", "+7.0", "+7.0", "+7.0"]
    assert [text.get_text() for text in ratio.texts][4:] == ["1.20", "1.50", "1.50", "1.50"]
    assert [axes.patches[0].get_xy() for axes in (first, ratio)] == [(-0.5, 0.5)] * 2


def test_curves_are_drawn_at_the_middle_of_their_blocks():
    curve = CLAIM.draw(result()).axes[0].lines[0]
    assert curve.get_xdata().tolist() == [1.0, (2 * 60) ** 0.5]  # episode 1, and 2 … 60


def test_schedules_in_words():
    assert schedule_in_words(SCHEDULES[0]) == "ε = 0.1"
    assert schedule_in_words(SCHEDULES[1]) == "ε = 1, × 0.98 an episode to 0.01"
