"""`lifelore live` in domains of jobs with hidden types, and `lifelore explain`: documents, words, and refusals."""

import gymnasium
import pytest

from lifelore import LongLivedAgent

TASK = {
    "task", "context", "hidden_type", "best_return", "returns", "prior", "alarm", "alarm_score", "learnt",
    "new_type", "first_episode", "last_episode", "spare",
}  # fmt: skip


@pytest.fixture
def where(tmp_path):
    return str(tmp_path / "memory.db")


def live(ask, where, *more, tasks=4):
    fixed = ("live", "--domain", "factory-customers", "--memory", where, "--set", "episodes=2", "--json")
    run = ask(*fixed, "--tasks", str(tasks), *more)
    assert run.status == 0, run.err
    return run.document


def test_a_life_goes_on_where_it_ended(ask, where):
    first, second = live(ask, where), live(ask, where)
    assert [set(task) for task in first["tasks"]] == [TASK] * 4
    assert [task["task"] for task in first["tasks"] + second["tasks"]] == list(range(8))
    assert first["tasks"][0]["prior"] == {}
    assert second["tasks"][0]["prior"]
    whole = live(ask, where.replace("memory", "whole"), tasks=8)
    assert whole["tasks"] == first["tasks"] + second["tasks"]


def test_explain_says_why(ask, where):
    live(ask, where)
    run = ask("explain", "3", "--memory", where)
    assert run.status == 0
    assert run.out.startswith("task 3, context")
    assert "first episode, return" in run.out
    assert "as for" in run.out
    document = ask("explain", "3", "--memory", where, "--json").document
    assert set(document) == TASK | {"domain", "seed"}


def test_explain_reads_a_task_of_a_world_of_ones_own(ask, where):
    with LongLivedAgent(key="lake", memory=where, episodes=3, max_steps=20) as agent:
        lake = gymnasium.make("FrozenLake-v1")
        results = [agent.live(lake, context="monday") for _ in range(2)]
        assert ask("explain", "1", "--memory", where).out == agent.explain(results[1]) + "\n"
    assert ask("explain", "0", "--memory", where, "--json").document["returns"] == results[0].returns


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["live", "--domain", "factory-customers", "--map", "a.yaml"], "--map does not apply to domain"),
        (["live", "--domain", "factory-customers", "--out", "a"], "lifelore serve draws the life at /life"),
        (["live", "--domain", "factory-customers", "--agent", "lore"], "agent must be one of full"),
        (["live", "--domain", "factory-customers", "--set", "spare=1", "--agent", "scratch"], "must be full"),
        (["live", "--domain", "building", "--set", "spare=1"], "applies to jobs with hidden types alone"),
        (
            ["live", "--domain", "factory-customers", "--set", "cell=1"],
            "cell does not apply to domain factory-cus",
        ),
        (["live", "--domain", "building-days", "--tasks", "0"], "tasks must be at least 1"),
        (["explain", "9"], "has no task 9"),
    ],
)
def test_mistakes_are_one_line(ask, where, arguments, words):
    if arguments[0] == "explain":
        live(ask, where, tasks=1)
    run = ask(*arguments, "--memory", where)
    assert run.status == 2
    assert words in run.refusal
