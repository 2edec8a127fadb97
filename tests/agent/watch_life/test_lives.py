"""The lives in a memory: both kinds, what else is stored there, tasks in their order, and reasons in words."""

from pathlib import Path

import pytest

from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.agent.long_lived.explanation import explained
from lifelore.agent.long_lived.long_life import live_long
from lifelore.agent.watch_life.known_family import TELLING_CAUSES, known_family
from lifelore.agent.watch_life.lives import lives_in, task_of, tasks_of
from lifelore.core.errors import NotFoundError
from lifelore.domains.worlds import WorldSettings
from lifelore.memory import open_memory

FACTORY = "factory-customers"


@pytest.fixture(scope="module")
def lived(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, dict, dict]:
    """A memory with a life of each kind, and their reports."""
    where = str(tmp_path_factory.mktemp("lives") / "m.db")
    in_grid = live(
        LifeSettings(WorldSettings("lattice", size=7), memory=MemorySettings(where, "ada"), tasks=3, jobs=1)
    ).report
    types = live_long(FACTORY, tasks=4, episodes=3, robot="bo", memory=where)
    with open_memory(where) as memory:
        memory.contribute("hall: cart", [], process="p", seq=0, task={"index": 0, "goal": [0, 0], "world": "w"})
        memory.contribute("ada", [], process="another", seq=0, task={"run": 1})
    return where, in_grid, types


def test_a_life_for_each_robot_and_domain(lived):
    with open_memory(lived[0]) as memory:
        assert lives_in(memory) == [
            {"robot": "ada", "domain": "lattice", "kind": "grid", "tasks": 3},
            {"robot": "bo", "domain": FACTORY, "kind": "types", "tasks": 4},
            {"robot": "hall: cart", "domain": "grid", "kind": "grid", "tasks": 1},
        ]


def test_an_empty_memory_has_no_life(tmp_path):
    with open_memory(tmp_path / "m.db") as memory:
        assert lives_in(memory) == []


def test_tasks_on_a_map_have_the_results_of_their_report(lived):
    with open_memory(lived[0]) as memory:
        rows = tasks_of(memory, "ada", "lattice")
        assert [row["task"] for row in rows] == [0, 1, 2]
        for row, reported in zip(rows, lived[1]["tasks"], strict=True):
            assert row["goal"] == reported["goal"]
            assert row["agents"] == reported["agents"]
        places = [row["places"] for row in rows]
        assert places == sorted(places)
        assert 0 < places[0] <= places[-1] <= 21
        assert task_of(memory, "ada", "lattice", 1) == rows[1]


def test_tasks_of_hidden_types_are_those_of_their_report_in_words_too(lived):
    with open_memory(lived[0]) as memory:
        rows = tasks_of(memory, "bo", FACTORY)
        for row, reported in zip(rows, lived[2]["tasks"], strict=True):
            assert row["task"] == reported["task"]
            assert (row["first"], row["last"]) == (reported["returns"][0], reported["returns"][-1])
            assert row["best"] == reported["best_return"]
        document = task_of(memory, "bo", FACTORY, 2)
        assert document["words"] == explained(lived[2]["tasks"][2])
        assert document["seed"] == 0


def test_a_missing_life_or_task_is_named(lived):
    with open_memory(lived[0]) as memory:
        with pytest.raises(NotFoundError, match="'ada' has no task of 'factory-customers'"):
            tasks_of(memory, "ada", FACTORY)
        with pytest.raises(NotFoundError, match="'bo' has no task 9 of"):
            task_of(memory, "bo", FACTORY, 9)


def test_without_transitions_the_domain_of_a_map_is_unknown(tmp_path: Path):
    where = str(tmp_path / "m.db")
    settings = LifeSettings(WorldSettings("lattice", size=7), agent="prior", memory=MemorySettings(where), tasks=1)
    live(settings)
    with open_memory(where) as memory:
        assert lives_in(memory) == [{"robot": "robot", "domain": "grid", "kind": "grid", "tasks": 1}]
        assert "places" not in tasks_of(memory, "robot", "grid")[0]


def test_a_family_knows_its_types_and_what_to_expect(lived):
    with open_memory(lived[0]) as memory:
        found = known_family(memory, FACTORY)
    assert found["tasks"] == 4
    names = {one["name"] for one in found["types"]}
    learnt = {task["learnt"] for task in lived[2]["tasks"]}
    assert {name for joined in names for name in joined.split("+")} >= learnt
    assert sum(one["tasks"] for one in found["contexts"]) >= 4
    interests = [one["interest"] for one in found["contexts"]]
    assert interests == sorted(interests, reverse=True)
    for one in found["contexts"]:
        assert set(one["expected"]) == names
        assert sum(one["expected"].values()) == pytest.approx(1, abs=1e-3)
        assert one["unsure"] == pytest.approx(max(0, one["entropy"] - one["disagreement"]), abs=2e-4)
    for one in found["types"]:
        assert len(one["telling"]) == TELLING_CAUSES
        assert all("component" in line and ("paid" in line or "refused" in line) for line in one["telling"])


def test_a_family_that_nobody_lived_is_empty_and_a_wrong_name_is_refused(tmp_path):
    with open_memory(tmp_path / "m.db") as memory:
        assert known_family(memory, FACTORY) == {"tasks": 0, "types": [], "contexts": []}
        with pytest.raises(NotFoundError, match="domain must be one of"):
            known_family(memory, "nowhere")
