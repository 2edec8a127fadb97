"""Measures of C3.15 from made-up cells, by hand."""

from itertools import product

import pytest

from lifelore.core.errors import InputError
from reproduction.chapter3.advice.mazes import AGENTS
from reproduction.chapter3.c3_15_advice_table.figure import PRINTED
from reproduction.chapter3.c3_15_advice_table.measure import measure, rows
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.15")
FULL = dict(claim_of("C3.15").sizes["full"])
QUICK = dict(claim_of("C3.15").sizes["quick"])

SETTINGS = {**QUICK, "tasks": 4, "loops": [0.1, 0.4], "advised_alpha0": [0.1]}
SETTINGS["buildings"] = QUICK["buildings"][:2]
ARRIVED = {"none": 1, "thesis": 3, "better": 4, "uniform only": 2, "goal unknown": 1}
"""Of four tasks, by who advises; one less in maze 0, and at loops 0.4 the thesis's advisor does not help."""


def arrived(agent, way, loops, maze):
    if agent == "optimal":
        return 4
    if way == "thesis" and loops == 0.4:
        way = "none"
    return ARRIVED[way] - (maze == 0)


def entry(agent, way, experts, loops, maze):
    n = arrived(agent, way, loops, maze)
    advised = {"none": 0, "thesis": 50, "better": 40 if agent == "bug" else 10}.get(way, 20)
    steps = [100] * n + [200] * (4 - n)
    return {
        "experts": experts,
        "way": way,
        "agent": agent,
        "reached": [1] * n + [0] * (4 - n),
        "steps": steps,
        "advised": [advised if s == 100 else 0 for s in steps],
    }


def made_up():
    cells = []
    for loops in SETTINGS["loops"]:
        for maze in range(3):
            walks = [entry(agent, "none", None, loops, maze) for agent in AGENTS]
            for experts in SETTINGS["experts"]:
                ways = ["thesis", "better", "uniform only"]
                if (loops, experts) == (0.1, "walks"):
                    ways.append("goal unknown")
                walks += [entry(agent, way, experts, loops, maze) for way in ways for agent in AGENTS]
            learners = [{"experts": None, "final": [0.0, 100.0 * maze]}]
            learners += [{"experts": e, "final": [1000.0, 900.0]} for e in SETTINGS["experts"]]
            cells.append({"loops": loops, "maze": maze, "walks": walks, "learners": learners})
    return cells + beside()


def beside():
    """Two buildings of three mazes: alone 100, advised 300 more by maze; with α⁰ 0.1 the bug gains nothing."""
    cells = []
    for place, maze in product(range(2), range(3)):
        rewards = []
        for alpha0 in (None, 0.0) if place else (None, 0.0, 0.1):
            for agent in (*AGENTS, "q-learning"):
                stays = agent == "optimal" or (agent, alpha0) == ("bug", 0.1)
                gain = 0.0 if alpha0 is None or stays else 300.0 + 100 * maze
                start = 1000.0 if agent == "optimal" else 100.0
                rewards.append({"alpha0": alpha0, "agent": agent, "reward": start + gain})
        cells.append({"building": place, "maze": maze, "walls": 0.25 + 0.25 * place, "rewards": rewards})
    return cells


def test_headline_by_hand():
    found = measure(SETTINGS, made_up())
    # Without advice 0, 1, 1 of 4 tasks in the three mazes; with the thesis's 2, 3, 3.
    assert found["optimal_thesis"].value == 1000.0
    assert found["explorers_raised"].value == 4
    assert found["thesis_least"].value == pytest.approx(1000 * 8 / 12)
    assert found["better_least"].value == pytest.approx(1000 * 11 / 12)
    assert found["uniform_only_least"].value == pytest.approx(1000 * 5 / 12)
    assert found["goal_unknown_least"].value == pytest.approx(1000 * 2 / 12)


def test_advised_shares_by_hand():
    found = measure(SETTINGS, made_up())
    assert found["better_most_advised"].value == 40


def test_learning_by_hand():
    found = measure(SETTINGS, made_up())
    assert found["q_learning_thesis"].value == 950.0
    assert found["q_learning_gain"].value == 900.0


def test_shares_of_the_grid_by_hand():
    found = measure(SETTINGS, made_up())
    # Of 2 loop densities × 2 kinds of experts.
    assert (found["grid_all_raised"].value, found["grid_all_raised"].n) == (0.5, 4)


def test_buildings_beside_the_default_by_hand():
    found = measure(SETTINGS, made_up())
    # Each explorer gains 300, 400 and 500 in the three mazes.
    gains = [found[f"one_start_{agent}_gain"] for agent in ("random", "avoid", "left", "bug")]
    assert [gain.value for gain in gains] == [400] * 4
    assert all(300 <= gain.ci95[0] < gain.ci95[1] <= 500 for gain in gains)
    assert (found["one_start_random_none"].value, found["one_start_random_thesis"].value) == (100, 500)
    assert found["one_start_q-learning_gain"].value == 400
    assert (found["default_walls"].value, found["open_walls"].value) == (0.25, 0.5)
    assert found["open_random_gain"].value == 400
    # Two of four cells of the grid and the open building; not the default with α⁰ 0.1, where the bug stays.
    assert (found["crossed_all_raised"].value, found["crossed_all_raised"].n) == (0.5, 6)
    # Q-learning gains 950, 900 and 850 in the whole grid, and 300 to 500 beside it.
    assert (found["crossed_learning_raised"].value, found["crossed_learning_raised"].n) == (1.0, 6)


def test_an_open_gain_leaves_the_verdict_open():
    second = CLAIM.second
    measured = {name: number.to_dict() for name, number in measure(SETTINGS, made_up()).items()}
    assert second.answers(measured, "headline") == ["yes"] * 5
    measured["one_start_random_gain"] |= {"value": -40.6, "ci95": [-116.0, 28.0]}
    assert second.answers(measured, "headline") == ["open", *["yes"] * 4]
    assert second.verdict(measured) == "undecided"


def test_rows_hold_the_whole_grid():
    found = rows(SETTINGS, made_up())
    by_building = [row for row in found if "building" in row]
    assert len(by_building) == (2 + 1 + 2) * (len(AGENTS) + 1)
    walked = {(row["building"]["name"], row["alpha0"], row["walker"]): row for row in by_building}
    assert walked["open", 0.0, "bug"]["gain"] == 400.0
    still = walked["default", 0.1, "bug"]
    assert (still["reward"], still["gain"], still["gain_is_certain"]) == (100.0, 0.0, False)
    assert all(("gain" in row) == (row["alpha0"] is not None) for row in by_building)
    found = [row for row in found if "way" in row]
    assert len(found) == 4 * (4 * len(AGENTS) + 2)
    first = next(r for r in found if r["way"] == "thesis" and r["agent"] == "avoid")
    assert (first["gain"], first["gain_is_certain"], first["reward"]) == (500.0, True, 666.7)
    # Half of each walk that arrives is advised, 2, 3 and 3 of 4 walks.
    assert (first["advised"], first["median_steps"]) == (33.3, 100.0)
    assert found[0]["reward"] == 166.7
    learning = [row for row in found if row["agent"] == "q-learning"][:2]
    assert [row["reward"] for row in learning] == [50.0, 950.0]
    assert all("gain" not in r for r in found if r["way"] == "none")


def test_printed_table_and_full_size_are_the_thesiss():
    assert set(PRINTED) == {*AGENTS, "q-learning"}
    assert (FULL["size"], FULL["kappa"], FULL["window"], FULL["max_steps"]) == (30, 0.5, 300, 5000)
    assert (FULL["q_learning"]["episodes"], FULL["q_learning"]["max_episode_steps"]) == (5000, 200)
    assert FULL["tasks"] >= 20


@pytest.mark.parametrize(
    ("overrides", "rule"),
    [
        ({"q_learning": '{"tasks": 1}'}, "q_learning must have exactly"),
        ({"buildings": "[]"}, "the first building must be the default"),
        ({"buildings": '[{"size": 13}]'}, "a building must have name, size, loops, others"),
    ],
)
def test_settings_that_limits_cannot_describe(overrides, rule):
    with pytest.raises(InputError, match=rule):
        CLAIM.settings("quick", overrides)
