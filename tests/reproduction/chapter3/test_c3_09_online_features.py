"""Measures of C3.9 from made-up tasks, by hand, and a few small tasks."""

import pytest

from lifelore.core.errors import InputError
from reproduction.chapter3.c3_09_online_features.measure import measure, rows
from reproduction.chapter3.c3_09_online_features.run import (
    METHODS,
    first_grid_of,
    grid_of,
    run_cell,
)
from reproduction.chapter3.factory.modified_tasks import learn_problem, problem_of
from reproduction.chapter3.factory.online_selection import Counting, OnlineAgent
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.curve_blocks import block_edges
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.9")
QUICK = dict(claim_of("C3.9").sizes["quick"])
FULL_SIZE = claim_of("C3.9").settings("full")

SETTINGS = {
    **QUICK,
    "runs": 4,
    "sources": ["learnt", "learnt, promising", "exact"],
    "schedules": [[1.0, 0.85, 0.01]],
    "ties": ["uniform"],
}
SETTINGS = {**SETTINGS, "max_steps": [300]}
"""A grid of three cells: whose policies count."""
FIRST = {"uniform": -9000.0, "full": -4000.0, "selected": -3500.0}
LAST = {"uniform": -100.0, "full": -100.0, "selected": -100.0}
END = {"uniform": 3.0, "full": 2.0, "selected": 4.0}
JITTER = [-3.0, 1.0, -1.0, 3.0]


def made_up(first=FIRST, last=LAST, learnt_first=None, settings=SETTINGS):
    """Four runs of three tasks; the first task, in which nobody has a prior, is another number altogether."""

    def numbers(method, how, run):
        of_cell = learnt_first if learnt_first and "learnt" in (how["source"] or "") else first
        place = METHODS.index(method)
        jitter = JITTER[(run + place) % 4] * (1 + 0.1 * place)
        firsts = [-8000.0, of_cell[method] + jitter - 10, of_cell[method] + jitter + 10]
        found = {"first": firsts, "last": [-500.0] + [last[method] + jitter] * 2, "n_features": [10, 5, 4]}
        found |= {"loss": [5.0] * (len(block_edges(SETTINGS["long_episodes"])) - 1), "loss_at_end": END[method]}
        return {"method": method, **how, **found}

    met = [(method, cell) for method in METHODS for cell in grid_of(settings).cells_of(method)]
    return [
        {"run": run, "optimal": [7.0, 0.0, 0.0], "found": [numbers(*at, run) for at in met]} for run in range(4)
    ]


def plain(measured):
    return {name: number.to_dict() for name, number in measured.items()}


def test_the_grid_has_a_row_for_each_cell():
    assert rows(SETTINGS, made_up())[1]["first_uniform"] == pytest.approx(-9000)


def test_the_first_task_takes_no_part_in_differences_by_hand():
    found = measure(SETTINGS, made_up())
    assert found["optimal_reward"].value == 0.0
    assert found["exact_first_selected_minus_full"].value == pytest.approx(500)
    assert found["learnt_first_full_minus_uniform"].value == pytest.approx(5000)
    assert found["learnt_last_selected_minus_uniform_of_distance"].value == pytest.approx(0, abs=1e-9)
    assert found["exact_features_after_last_task"].value == 4.0
    assert found["grid_order_at_first"].value == 1.0


def test_differences_as_shares_of_the_optimal_rewards_size_by_hand():
    results = made_up()
    for result, ends in zip(results, ([-40.0, 20.0], [-30.0, 40.0], [-20.0, 60.0], [-10.0, 80.0]), strict=True):
        result["optimal"] = [7.0, *ends]
    found = measure(SETTINGS, results)
    assert found["optimal_size"].value == pytest.approx((100 + 200) / 8)
    # Of the last task alone (`long_tasks` 1): 20, 40, 60 and 80; what is lost less is gained.
    assert found["learnt_promising_end_selected_minus_full_of_optimal"].value == pytest.approx(-2 / 50)
    assert found["exact_end_full_minus_uniform_of_optimal"].value == pytest.approx(1 / 50)
    assert found["exact_end_selected_below_optimal"].value == pytest.approx(4 / 50)
    assert found["learnt_last_selected_minus_full_of_optimal"].value == pytest.approx(0, abs=1e-9)


def test_the_last_tasks_are_learnt_on_with_the_priors_so_far():
    settings = {**QUICK, "tasks": 2, "episodes": 4, "long_episodes": 6, "long_last": 2}
    result = run_cell(settings, {"run": 0}, 8)
    on = [f for f in result["found"] if "loss" in f]
    assert {(f["method"], f["source"]) for f in on} == {
        ("uniform", None), *((m, s) for m in METHODS[1:] for s in settings["sources"])
    }  # fmt: skip
    how = {**settings, "max_steps": 300}
    agent = OnlineAgent(True, Counting("learnt", "visited"), 0.1, "uniform")
    agent.learn(problem_of(settings, (8, "C3.9", 0, 0)), schedule_of(how, [1.0, 0.85, 0.01]))
    problem = problem_of(settings, (8, "C3.9", 0, 1))
    long = schedule_of({**how, "episodes": 6}, settings["long_schedule"])
    loss = problem.optimal - learn_problem(problem, agent.rows(problem), long)[0].rewards
    ours = next(f for f in on if (f["method"], f["source"]) == ("selected", "learnt, promising"))
    assert ours["loss_at_end"] == pytest.approx(loss[-2:].mean())


def test_verdicts():
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up()))) == "holds"
    # 600 of the 9000 between uniform's first episode and the optimum are more than 5 %.
    apart = measure(SETTINGS, made_up(last={**LAST, "uniform": -700.0}))
    assert apart["exact_last_full_minus_uniform_of_distance"].value == pytest.approx(600 / 9000)
    assert CLAIM.predicate.verdict(plain(apart)) == "holds in part"
    poor = {**FIRST, "full": -9500.0, "selected": -9400.0}
    half = measure(SETTINGS, made_up(learnt_first=poor))
    assert half["grid_order_at_first"].value == pytest.approx(1 / 3)
    assert CLAIM.predicate.verdict(plain(half)) == "holds in part"
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up(first=poor)))) == "does not hold"


def test_every_condition_asks_of_something_measured():
    assert CLAIM.read_measures() <= set(measure(SETTINGS, made_up()))


def test_the_first_grid_is_the_default_and_every_other_choice_alone():
    default = FULL_SIZE["default"]
    assert first_grid_of(FULL_SIZE).cells == (
        default,
        {**default, "source": "learnt, promising"},
        {**default, "source": "exact"},
        {**default, "schedule": [0.1, 1.0, 0.1]},
        {**default, "ties": "prior"},
        {**default, "max_steps": 2000},
    )


def test_the_grid_crosses_all_choices_and_holds_the_first():
    grid = grid_of(FULL_SIZE)
    assert len({grid.key(cell) for cell in grid.cells}) == len(grid.cells) == 3 * 2 * 2 * 2
    assert all(cell in grid.cells for cell in first_grid_of(FULL_SIZE).cells)
    # Learners without a prior read the schedule and the cap.
    assert len(grid.cells_of("uniform")) == 2 * 2


def test_shares_of_both_grids_by_hand():
    settings = {**SETTINGS, "ties": ["uniform", "prior"], "max_steps": [100, 300]}
    results = made_up(settings=settings)
    for result in results:
        for found in result["found"]:
            if found["source"] == "exact" and found["ties"] == "prior":
                found["first"] = [-8000.0, -20000.0, -20000.0]
    found = measure(settings, results)
    # The default, two other sources, the other ties and the other cap: exact policies meet the default ties there.
    assert (found["grid_order_at_first"].value, found["grid_order_at_first"].n) == (1.0, 5)
    # Of 3 × 2 × 2 cells, two have exact policies and ties by the prior.
    crossed = found["crossed_grid_order_at_first"]
    assert (crossed.value, crossed.n) == (pytest.approx(10 / 12), 12)


def test_alike_is_within_five_percent_of_the_optimal_reward_by_hand():
    results = made_up()
    for result in results:
        result["optimal"] = [7.0, -200.0, 0.0]
        for found in result["found"]:
            found["last"] = [-500.0, *[-100.0 - 3 * METHODS.index(found["method"])] * 2]
            if (found["method"], found["source"]) == ("selected", "exact"):
                found["last"] = [-500.0, -93.0, -93.0]
    measured = measure(SETTINGS, results)
    # 5 % of a size of 100 is 5. Rewards span 6 with both learnt sources, and 10 with exact policies.
    assert measured["crossed_grid_alike_at_last"].value == 0.0
    for result in results:
        result["optimal"] = [7.0, -240.0, 20.0]
    measured = measure(SETTINGS, results)
    # 5 % of 130 is 6.5. Of the last task's 20 it is 1: the losses 2, 3 and 4 when learnt on span 2.
    assert measured["crossed_grid_alike_at_last"].value == pytest.approx(2 / 3)
    assert (measured["sources_alike_at_end"].value, measured["sources_alike_at_end"].n) == (0.0, 3)
    for result in results:
        for found in result["found"]:
            if found["source"] == "exact":
                found["loss_at_end"] = 3.5
    assert measure(SETTINGS, results)["sources_alike_at_end"].value == pytest.approx(1 / 3)


def test_a_small_run_agrees_with_an_agent_of_its_own():
    settings = {**QUICK, "tasks": 2, "episodes": 4}
    result = run_cell(settings, {"run": 0}, 8)
    found = {
        (f["method"], f["source"]): f
        for f in result["found"]
        if f["schedule"] == [1.0, 0.85, 0.01] and f["max_steps"] == 300 and f["ties"] != "prior"
    }
    assert set(found) == {("uniform", None), *((m, s) for m in METHODS[1:] for s in settings["sources"])}
    schedule = schedule_of({**settings, "max_steps": 300}, [1.0, 0.85, 0.01])
    agent = OnlineAgent(True, Counting("learnt", "tried"), 0.1, "uniform")
    for i in range(2):
        problem = problem_of(settings, (8, "C3.9", 0, i))
        rewards = agent.learn(problem, schedule).rewards
        ours, uniform = found["selected", "learnt"], learn_problem(problem, None, schedule)[0].rewards
        assert [ours["first"][i], ours["last"][i]] == [rewards[0], rewards[-1]]
        assert [found["uniform", None][part][i] for part in ("first", "last")] == [uniform[0], uniform[-1]]
        assert ours["n_features"][i] == len(agent.chosen)
        assert result["optimal"][i] == problem.optimal
    # Nobody has a prior in the first task.
    assert len({str((f["first"][0], f["last"][0])) for f in found.values()}) == 1


def test_the_figure_is_drawn_from_rows_alone():
    results = made_up()
    result = {"settings": SETTINGS, "measured": plain(measure(SETTINGS, results)), "rows": rows(SETTINGS, results)}
    learnt, _, exact, _, on, _, *tables = CLAIM.draw(result).axes
    assert learnt.get_title(loc="left") == "policies counted: learnt"
    assert len(exact.lines) == 2 * len(METHODS)
    assert on.get_title(loc="left") == "learnt on: learnt, promising"
    assert len(on.lines) == len(METHODS) + 1
    # Of the 9000 between no prior and the optimum all ten features gain 5000 and selected ones 500 more.
    assert [[text.get_text() for text in table.texts] for table in tables] == [["56"] * 3, ["6"] * 3, ["0"] * 3]
    sides = [label.get_text() for label in tables[0].get_yticklabels()]
    assert sides == ["learnt; cap 300", "learnt, promising; cap 300", "exact; cap 300"]
    (frame,) = tables[0].patches
    assert frame.get_xy() == (-0.5, 0.5)  # the second row: the source that the headlines judge


def test_settings_without_a_source_that_the_claim_asks_about():
    with pytest.raises(InputError, match="sources must hold exact and learnt"):
        CLAIM.settings("quick", {"sources": ["learnt"]})
