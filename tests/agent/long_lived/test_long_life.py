"""`live_long` on three doors: with and without memory, continued, ablated, refreshed, stopped."""

from threading import Event

import pytest

from lifelore.agent.long_lived.long_life import live_long, recalled, stored_task, summary
from lifelore.agent.long_lived.task_family import AGENTS
from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.task_stream import TaskStream
from lifelore.memory import open_memory
from tests.agent.long_lived.doors import Doors

FAMILY = Doors(TaskStream(("0", "1"), n_contexts=2, loyalty=1.0, zipf=0.0))


def test_a_life_without_a_memory_is_that_in_a_file_and_that_of_its_halves(tmp_path):
    once = live_long(FAMILY, tasks=6, episodes=3)
    assert live_long(FAMILY, tasks=6, episodes=3, memory=tmp_path / "whole.db") == once
    assert (once["domain"], once["agent"], once["seed"]) == ("doors", "full", 0)
    assert [(task["task"], len(task["returns"])) for task in once["tasks"]] == [(n, 3) for n in range(6)]
    once = once["tasks"]
    first = live_long(FAMILY, tasks=4, episodes=3, memory=tmp_path / "m.db")["tasks"]
    with open_memory(tmp_path / "m.db") as memory:
        second = live_long(FAMILY, tasks=2, episodes=3, memory=memory)["tasks"]
        assert memory.tasks("robot") == 6
    assert first + second == once
    assert stored_task(5, memory=tmp_path / "m.db") == once[5] | {"domain": "doors", "seed": 0}


@pytest.mark.parametrize("agent", [name for name in AGENTS if name != "full"])
def test_an_agent_without_some_part_stores_no_lesson(tmp_path, agent):
    live_long(FAMILY, tasks=3, episodes=2, agent=agent, memory=tmp_path / "m.db", refresh=True)
    with open_memory(tmp_path / "m.db") as memory:
        assert recalled(FAMILY, memory).n_tasks == 0
        assert memory.tasks("robot") == 3


@pytest.mark.parametrize("refresh", [False, True])
def test_refresh_learns_from_another_robot_between_tasks(tmp_path, refresh):
    where = tmp_path / "m.db"

    def other_lives(document):
        if not document["task"]:
            live_long(FAMILY, tasks=4, episodes=3, memory=where, robot="other")

    report = live_long(FAMILY, tasks=2, episodes=3, memory=where, refresh=refresh, watch=other_lives)
    first, second = (task["first_episode"][0]["belief"] for task in report["tasks"])
    assert set(first) == {"an unknown type"}
    assert any("of other" in name for name in second) == refresh


def test_spare_tasks_are_in_contexts_of_the_agents_choice():
    report = live_long(FAMILY, tasks=4, episodes=2, spare=3)
    assert [task["spare"] for task in report["tasks"]] == [False] * 4 + [True] * 3
    assert {task["context"] for task in report["tasks"][4:]} <= {task["context"] for task in report["tasks"][:4]}


def test_progress_watch_and_stop(tmp_path):
    ticks, seen, stop = [], [], Event()

    def watch(document):
        seen.append(document["task"])
        if len(seen) == 2:
            stop.set()

    report = live_long(FAMILY, tasks=5, progress=lambda *tick: ticks.append(tick), stop=stop, watch=watch)
    assert seen == [0, 1] == [task["task"] for task in report["tasks"]]
    assert ticks[0] == (0, 5, "")
    assert [done for done, _, _ in ticks] == [0, 1, 2]
    first = report["tasks"][0]
    assert (
        ticks[1][2] == f"task 0: {first['returns'][0]:.1f} at first, best {first['best_return']:.1f}, a new type"
    )


def test_a_family_by_name_has_the_world_of_the_seed():
    one, other = (live_long("factory-customers", tasks=1, episodes=1, seed=seed)["tasks"] for seed in (0, 1))
    assert one[0]["best_return"] != other[0]["best_return"]


def test_the_summary_by_hand():
    def task(best, first, last, new):
        return {"best_return": best, "returns": [first, 0.0, last], "new_type": new}

    found = summary([task(10, 4, 9, True), task(8, 8, 8, False), task(5, 3, 5, False), task(6, 6, 2, True)])
    assert found == {
        "first half": {
            "tasks": 2, "first_episode_below_best": 3.0, "last_episode_below_best": 0.5, "new_types": 1
        },
        "second half": {
            "tasks": 2, "first_episode_below_best": 1.0, "last_episode_below_best": 2.0, "new_types": 1
        },
    }  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "error", "message"),
    [
        ({"agent": "lore"}, NotFoundError, "agent must be one of full, no-perception, .* in doors, got 'lore'"),
        ({"tasks": 0}, InputError, "tasks must be at least 1, got 0"),
        ({"spare": -1}, InputError, "spare must be at least 0, got -1"),
        ({"spare": 1, "agent": "scratch"}, InputError, "the agent must be full, got scratch"),
        ({"episodes": 0}, InputError, "episodes must be at least 1, got 0"),
        ({"false_alarm": 0.0}, InputError, "false_alarm must lie between 0 and 1, got 0.0"),
    ],
)
def test_settings_that_break_a_rule(tmp_path, changes, error, message):
    with pytest.raises(error, match=message):
        live_long(FAMILY, memory=tmp_path / "m.db", **changes)
    assert not (tmp_path / "m.db").exists()


def test_a_name_that_no_family_has():
    with pytest.raises(NotFoundError, match="domain must be one of tabletop, factory-customers, building-days"):
        live_long("kitchen")
