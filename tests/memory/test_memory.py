"""The public face of memory, on both back ends."""

import sys
from pathlib import Path

import numpy as np
import pytest

import lifelore.memory
from lifelore.core import InputError, MissingExtraError, NotFoundError, Record, StoreError
from lifelore.memory import Memory, open_memory
from lifelore.memory.schema import LATEST

LARGEST = 2**63 - 1


def record(values: dict[int, int], merge="add", key="b7", kind="prior", version=1, **about) -> Record:
    return Record(kind, key, version, merge, np.array(list(values)), np.array(list(values.values())), about)


def give(memory: Memory, robot: str, seq: int, *records: Record, process: str = "p") -> bool:
    return memory.contribute(robot, records, process=process, seq=seq, task={"index": seq})


def cells(memory: Memory, key="b7", kind="prior", version=1) -> dict[int, int] | None:
    found = memory.recall(kind, key, version)
    return None if found is None else dict(zip(found.slots.tolist(), found.values.tolist(), strict=True))


def test_all_names_can_be_imported():
    assert lifelore.memory.__all__ == ["Memory", "open_memory"]
    assert all(hasattr(lifelore.memory, name) for name in lifelore.memory.__all__)


def test_add_sums_slot_by_slot(memory):
    assert give(memory, "a", 0, record({5: 10, -3: 1}))
    assert give(memory, "b", 0, record({5: -4, LARGEST: 2}))
    found = memory.recall("prior", "b7", 1)
    assert found.slots.tolist() == [-3, 5, LARGEST]
    assert found.values.tolist() == [1, 6, 2]
    assert found.slots.dtype == found.values.dtype == np.int64
    assert found.merge == "add"


def test_some_slots_of_a_record(memory):
    give(memory, "a", 0, record({number: number * number for number in range(-3, 9)}))
    found = memory.recall("prior", "b7", 1, slots=(2, 4))
    assert (found.slots.tolist(), found.values.tolist()) == ([2, 3, 4], [4, 9, 16])
    assert memory.recall("prior", "b7", 1, slots=(20, 30)).slots.tolist() == []
    assert memory.recall("prior", "none", 1, slots=(2, 4)) is None


def test_a_replay_changes_nothing(memory):
    give(memory, "a", 0, record({1: 1}))
    before = memory.show()
    assert not give(memory, "a", 0, record({1: 1}))
    assert not give(memory, "a", 0, record({1: 50}))
    assert memory.show() == before
    assert give(memory, "a", 0, record({1: 1}), process="another")
    assert cells(memory) == {1: 2}


def test_keys_kinds_and_versions_never_mix(memory):
    give(memory, "a", 0, record({1: 1}), record({1: 2}, key="b8"), record({1: 3}, version=2),
         record({1: 4}, kind="model"))  # fmt: skip
    assert [cells(memory), cells(memory, key="b8"), cells(memory, version=2)] == [{1: 1}, {1: 2}, {1: 3}]
    assert cells(memory, kind="model") == {1: 4}
    assert [(key, version) for key, version, _ in memory.keys("prior")] == [("b7", 1), ("b7", 2), ("b8", 1)]


def test_what_is_unknown_is_none_or_zero(memory):
    assert memory.recall("prior", "nowhere", 1) is None
    assert memory.keys("prior") == []
    assert memory.tasks("nobody") == 0
    assert memory.robots() == []


def test_an_empty_record_is_known(memory):
    give(memory, "a", 0, record({}, unit="1/1000"))
    assert cells(memory) == {}
    assert memory.keys("prior") == [("b7", 1, {"unit": "1/1000"})]


def test_a_task_without_records_counts(memory):
    assert give(memory, "a", 0)
    assert memory.tasks("a") == 1


def test_about_is_that_of_the_newest(memory):
    give(memory, "b", 0, record({1: 1}, map="old", note=[1, None]))
    give(memory, "a", 0, record({1: 1}, map="new"))
    assert memory.recall("prior", "b7", 1).about == {"map": "new"}
    assert memory.keys("prior") == [("b7", 1, {"map": "new"})]
    memory.forget("a")
    assert memory.recall("prior", "b7", 1).about == {"map": "old", "note": [1, None]}


def test_a_second_life_goes_on(where):
    with open_memory(where) as memory:
        give(memory, "a", 0, record({1: 1}))
    with open_memory(where) as memory:
        give(memory, "a", 1, record({1: 1}))
        assert memory.tasks("a") == 2
        assert cells(memory) == {1: 2}


def test_show_is_plain_data_with_exact_sums(memory):
    give(memory, "b", 0, record({1: LARGEST, 2: LARGEST, 3: -5}))
    give(memory, "a", 0, record({1: -(2**63), 2: -(2**63)}, key="low"))
    shown = memory.show()
    assert [robot["robot"] for robot in shown["robots"]] == ["a", "b"]
    assert all(robot["tasks"] == 1 and robot["first"] == robot["last"] for robot in shown["robots"])
    assert shown["lore"] == [
        {"kind": "prior", "key": "b7", "version": 1, "merge": "add", "slots": 3, "sum": 2 * LARGEST - 5},
        {"kind": "prior", "key": "low", "version": 1, "merge": "add", "slots": 2, "sum": -(2**64)},
    ]
    assert (shown["schema"], shown["forgotten"], shown["forgotten_records"]) == (LATEST, 0, 0)
    assert shown["location"] == memory.location


@pytest.mark.parametrize(("there", "more"), [(LARGEST, 1), (-(2**63), -1), (-(2**63), -(2**63)), (2**62, 2**62)])
def test_a_sum_beyond_64_bits_is_refused_and_nothing_changes(memory, there, more):
    give(memory, "a", 0, record({1: there, 2: 1}))
    before = memory.show()
    with pytest.raises(StoreError, match="64 bits") as refused:
        give(memory, "a", 1, record({2: 1, 1: more}))
    assert "\n" not in str(refused.value)
    assert memory.show() == before
    assert memory.check() == []
    assert give(memory, "a", 1, record({1: -1 if there > 0 else 1}))


def test_one_key_has_one_merge(memory):
    give(memory, "a", 0, record({1: 1}, "add"))
    before = memory.show()
    with pytest.raises(StoreError, match="add and by union"):
        give(memory, "a", 1, record({1: 1}, "union"))
    assert memory.show() == before


def test_forgotten_tasks_can_be_contributed_again_under_the_next_number(memory, tmp_path):
    for seq, name in enumerate(("bag", "csv", "bag")):
        memory.contribute("a", [record({1: 10**seq})], process=f"run {seq}", seq=0, task={"source": name})
    with open_memory(tmp_path / "copy.db") as copy:
        copy.merge_from(memory)
        assert memory.forget_tasks(lambda robot, task: (robot, task["source"]) == ("a", "bag")) == 2
        assert memory.forget_tasks(lambda robot, task: (robot, task["source"]) == ("a", "bag")) == 0
        assert cells(memory) == {1: 10}
        assert [memory.times_forgotten("a", f"run {seq}") for seq in range(3)] == [1, 0, 1]
        assert memory.is_known("a", "run 0", 0)
        assert not memory.is_known("a", "run 0", 1)
        assert memory.contribute("a", [record({1: 1})], process="run 0", seq=1, task={"source": "bag"})
        copy.merge_from(memory)  # which forgets and learns with it
        assert cells(copy) == cells(memory) == {1: 11}
    assert memory.check() == []


def test_forget_names_the_robots_there_are(memory):
    give(memory, "rosie", 0)
    with pytest.raises(NotFoundError, match="rosie"):
        memory.forget("rosy")


def test_a_refusal_names_a_few_robots_and_counts_the_others(memory):
    for number in range(12):
        give(memory, f"r{number:02}", 0)
    with pytest.raises(NotFoundError, match=r"known robots: r00, .*, r09 and 2 more$"):
        memory.forget("rosy")


def test_rebuild_changes_nothing_in_a_sound_memory(memory):
    for seq in range(5):
        give(memory, "a", seq, record({seq: 1, 9: 2}), record({1: seq}, "newest", key="n"))
    before = memory.show(), cells(memory), cells(memory, "n")
    memory.rebuild()
    assert (memory.show(), cells(memory), cells(memory, "n")) == before
    assert memory.check() == []


def test_stamps_follow_the_largest_there_is_when_the_clock_goes_back(memory, monkeypatch):
    give(memory, "a", 0, record({1: 1}, "newest"))
    monkeypatch.setattr("lifelore.memory.ledger.time.time_ns", lambda: 5)
    give(memory, "a", 1, record({1: 2}, "newest"))
    assert cells(memory) == {1: 2}
    assert memory.check() == []


def test_a_closed_memory_says_so(memory):
    memory.close()
    memory.close()
    with pytest.raises(StoreError, match="closed"):
        memory.tasks("a")


def test_any_name_comes_back_as_it_was(memory):
    names = ["a%s", "Zoë", "z'; DROP TABLE lifelore_cells; --", "机器人", "🤖", "%(x)s :y"]
    for seq, name in enumerate(names):
        give(memory, name, seq, record({1: 1}, key=name, **{name: name}), process=name)
    assert memory.robots() == sorted(names)
    assert [key for key, _, _ in memory.keys("prior")] == sorted(names)


def test_without_psycopg_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "psycopg", None)
    with pytest.raises(MissingExtraError, match=r"lifelore\[postgres\]"):
        open_memory("postgresql://localhost/lore")


def test_no_server_is_one_line_without_the_password():
    with pytest.raises(StoreError, match="server") as refused:
        open_memory("postgresql://me:s3cret@127.0.0.1:9/lore?connect_timeout=2")
    assert "s3cret" not in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("argument", ["", "mysql://localhost/lore", "sqlite:///x.db"])
def test_other_places_are_refused(argument):
    with pytest.raises(InputError, match="postgresql://"):
        open_memory(argument)


def test_what_is_only_read_is_neither_made_nor_changed(file, tmp_path: Path):
    with open_memory(file) as memory:
        give(memory, "a", 0, record({1: 1}))
    before = file.read_bytes()
    with open_memory(file, read_only=True) as memory:
        assert memory.tasks("a") == 1
        with pytest.raises(StoreError):
            give(memory, "a", 1, record({1: 1}))
    assert file.read_bytes() == before
    with pytest.raises(StoreError, match="does not exist"):
        open_memory(tmp_path / "no" / "m.db", read_only=True)
    assert not (tmp_path / "no").exists()


def test_a_memory_that_must_exist_is_not_created(file, tmp_path: Path):
    with pytest.raises(StoreError, match=r"no/m.db does not exist; check the path"):
        open_memory(tmp_path / "no" / "m.db", create=False)
    assert not (tmp_path / "no").exists()
    (tmp_path / "empty.db").touch()
    with pytest.raises(StoreError, match="holds no Lifelore memory"):
        open_memory(tmp_path / "empty.db", create=False)
    assert (tmp_path / "empty.db").read_bytes() == b""
    with open_memory(file) as memory:
        give(memory, "a", 0, record({1: 1}))
    with open_memory(file, create=False) as memory:
        give(memory, "a", 1, record({1: 1}))
        assert memory.tasks("a") == 2


def test_only_the_folder_of_the_users_own_memory_is_created(tmp_path: Path, monkeypatch):
    with pytest.raises(StoreError, match=r"memory: the folder .*/wrong/dir does not exist"):
        open_memory(tmp_path / "wrong" / "dir" / "life.db")
    assert not (tmp_path / "wrong").exists()
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "own"))
    with open_memory() as memory:
        assert memory.location == str(tmp_path / "own" / "lifelore" / "lifelore.db")
    (tmp_path / "c%20?#").mkdir()
    with open_memory(tmp_path / "c%20?#" / "m.db") as memory:
        give(memory, "a", 0, record({1: 1}))
    assert [path.name for path in (tmp_path / "c%20?#").iterdir()] == ["m.db"]


def test_durable_asks_sqlite_for_a_flush_at_every_commit(file):
    for durable, expected in [(False, 1), (True, 2)]:
        with open_memory(file, durable=durable) as memory, memory._store.reading() as conn:
            assert conn.value("PRAGMA synchronous") == expected


def test_the_revision_changes_with_the_content_and_only_with_it(memory, new_place, back_end):
    seen = [memory.revision()]

    def changed() -> bool:
        seen.append(memory.revision())
        return seen[-1] not in seen[:-1]

    give(memory, "a", 0, record({1: 1}))
    assert changed()
    give(memory, "a", 0, record({1: 1}))  # stored already
    memory.recall("prior", "b7", 1)
    assert not changed()
    give(memory, "b", 0, record({2: 1}))
    assert changed()
    memory.forget("a")
    assert changed()
    memory.forget_records([("prior", "b7", 1)])
    assert changed()
    with open_memory(new_place(back_end)) as other:
        give(other, "c", 0, record({3: 1}))
        memory.merge_from(other)
    assert changed()
    give(memory, "a", 1, record({1: 1}))
    assert changed()
