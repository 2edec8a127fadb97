"""The summary of a life, worked by hand."""

import pytest

from lifelore.agent.live.summary import summarise, third


def task(
    lore_steps, scratch_steps, lore_hits=0, scratch_hits=10, lore_first=5.0, scratch_first=-5.0, reached=True
):
    def agent(steps, hits, first, reached):
        return {
            "steps_to_80": steps,
            "steps_to_goal": steps // 2,
            "collisions": hits,
            "first_return": first,
            "episodes_to_80": 1,
            "reached": reached,
        }

    return {
        "agents": {
            "lore": agent(lore_steps, lore_hits, lore_first, reached),
            "scratch": agent(scratch_steps, scratch_hits, scratch_first, True),
        }
    }


def test_thirds():
    assert third(list(range(7)), "first") == [0, 1]
    assert third(list(range(7)), "last") == [5, 6]
    assert third([0], "last") == [0]


def test_ratios_are_of_means_and_medians_of_pairs_over_the_last_third():
    tasks = [task(999, 1)] * 6 + [task(100, 1000), task(300, 1000), task(200, 400, reached=False)]
    summary = summarise(tasks)
    steps = summary["lore_vs_scratch"]["steps_to_80_ratio"]
    assert steps["value"] == pytest.approx(600 / 2400)
    assert steps["median"] == 0.3
    assert (steps["n"], steps["raw"]) == (3, {"lore": 200.0, "scratch": 800.0})
    assert summary["lore_vs_scratch"]["jumpstart"]["value"] == 10.0
    assert summary["lore_vs_scratch"]["capped"] == {"lore": 1, "scratch": 0}
    assert summary["agents"]["lore"]["first"]["steps_to_80"]["value"] == 999
    assert summary["agents"]["lore"]["first"]["steps_to_goal"]["value"] == 499
    assert summary["agents"]["lore"]["last"]["capped"] == 1


def test_a_ratio_to_nothing_is_null():
    ratio = summarise([task(1, 1, scratch_hits=0)])["lore_vs_scratch"]["collisions_ratio"]
    assert (ratio["value"], ratio["median"], ratio["ci95"], ratio["n"]) == (None, None, None, 1)


def test_an_agent_alone_has_no_comparison():
    alone = {"agents": {"scratch": task(1, 2)["agents"]["scratch"]}}
    assert set(summarise([alone])) == {"agents"}
