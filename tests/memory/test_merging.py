"""Merging is exact in any order and grouping, with replays and forgetting; against a plain model."""

import signal
import sqlite3
import subprocess
import sys
from dataclasses import dataclass, field
from functools import reduce
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lifelore.core import NotFoundError, Record, StoreError
from lifelore.memory import Memory, open_memory

ROBOTS = ("a", "b", "ä")
MERGES = ("add", "newest", "union")
Identity = tuple[str, str, int]


def lore(identity: Identity) -> list[Record]:
    """What this contribution holds; a replay holds the same."""
    draw = np.random.default_rng([ROBOTS.index(identity[0]), identity[2]])
    slots = np.flatnonzero(draw.random(8) < 0.5)
    return [Record("k", merge, 1, merge, slots, draw.integers(-50, 50, slots.size), {"from": list(identity)})
            for merge in draw.permutation(MERGES)[: draw.integers(1, 4)].tolist()]  # fmt: skip


@dataclass
class Model:
    """What a memory should hold: identities with the moment they were first made, and graves."""

    made: dict[Identity, int] = field(default_factory=dict)
    graves: set[Identity] = field(default_factory=set)

    def contribute(self, identity: Identity, moment: int) -> bool:
        if identity in self.made or identity in self.graves:
            return False
        self.made[identity] = moment
        return True

    def forget(self, robot: str) -> None:
        self.graves |= {one for one in self.made if one[0] == robot}
        self.made = {one: moment for one, moment in self.made.items() if one[0] != robot}

    def merge(self, other: "Model") -> None:
        self.graves |= other.graves
        both = [*other.made.items(), *self.made.items()]
        self.made = {one: min(moment for same, moment in both if same == one) for one, _ in both
                     if one not in self.graves}  # fmt: skip

    def cells(self, merge: str) -> dict[int, int]:
        found: dict[int, int] = {}
        rules = {"add": lambda a, b: a + b, "union": max, "newest": lambda a, b: b}
        for identity in sorted(self.made, key=lambda one: self.made[one]):
            for record in lore(identity):
                if record.merge == merge:
                    for slot, value in zip(record.slots.tolist(), record.values.tolist(), strict=True):
                        found[slot] = rules[merge](found[slot], value) if slot in found else value
        return found


which = st.integers(0, 2)
steps = st.one_of(
    st.tuples(st.just("contribute"), which, st.sampled_from(ROBOTS), st.integers(0, 3)),
    st.tuples(st.just("contribute"), which, st.sampled_from(ROBOTS), st.integers(0, 3)),
    st.tuples(st.just("merge"), which, which),
    st.tuples(st.just("forget"), which, st.sampled_from(ROBOTS)),
)
orders = st.permutations(range(3))


def take(step: tuple, moment: int, memories: list[Memory], models: list[Model]) -> None:
    memory, model = memories[step[1]], models[step[1]]
    if step[0] == "contribute":
        identity = (step[2], "p", step[3])
        stored = memory.contribute(step[2], lore(identity), process="p", seq=step[3], task={})
        assert stored == model.contribute(identity, moment)
    elif step[0] == "merge":
        memory.merge_from(memories[step[2]])
        model.merge(models[step[2]])
    elif any(one[0] == step[2] for one in model.made):
        memory.forget(step[2])
        model.forget(step[2])
    else:
        with pytest.raises(NotFoundError):
            memory.forget(step[2])


def content(memory: Memory) -> tuple:
    """All one can see of a memory, but for its place."""
    found = [(one.slots.tolist(), one.values.tolist(), one.about) if one else None
             for one in (memory.recall("k", merge, 1) for merge in MERGES)]  # fmt: skip
    return {name: part for name, part in memory.show().items() if name != "location"}, found, memory.keys("k")


def agrees(memory: Memory, model: Model) -> None:
    for merge in MERGES:
        found = memory.recall("k", merge, 1)
        cells = {} if found is None else dict(zip(found.slots.tolist(), found.values.tolist(), strict=True))
        assert cells == model.cells(merge)
    assert {robot: memory.tasks(robot) for robot in ROBOTS} == {
        robot: sum(one[0] == robot for one in model.made) for robot in ROBOTS
    }
    assert memory.show()["forgotten"] == len(model.graves)
    assert memory.check() == []


def merging_is_exact(life, first, second, left_first, places) -> None:
    """Live through `life` in three memories, unite them in two orders and groupings, compare with the model."""
    memories, models = [open_memory(place) for place in places], [Model() for _ in range(3)]
    try:
        for moment, step in enumerate(life):
            take(step, moment, memories, models)
        one, other = memories[3], memories[4]
        for index in first:  # ((0 + a) + b) + c
            one.merge_from(memories[index])
        memories[5].merge_many([memories[index] for index in second])  # all in one transaction
        a, b, c = (memories[index] for index in second)
        (a if left_first else b).merge_from(b if left_first else c)  # (a + b) + c, or a + (b + c)
        for part in (c, a, b):
            other.merge_from(part)
        assert content(one) == content(other) == content(memories[5])
        assert memories[5].check() == []
        agrees(one, reduce(lambda total, model: total.merge(model) or total, models, Model()))
        before = content(other)
        counts = [other.merge_from(part)["added"] for part in memories]
        assert (counts, content(other)) == ([0] * 6, before)
    finally:
        for memory in memories:
            memory.close()


# A slow first example and a shared, fresh-each-time fixture are both meant.
quick = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow, HealthCheck.data_too_large]}
lives = st.lists(steps, min_size=3, max_size=14)


@pytest.mark.slow
@settings(max_examples=30, **quick)
@given(life=lives, first=orders, second=orders, left_first=st.booleans())
def test_merging_is_exact_in_any_order_and_grouping(life, first, second, left_first, new_place):
    merging_is_exact(life, first, second, left_first, [new_place("sqlite") for _ in range(6)])


@pytest.mark.slow
@settings(max_examples=8, **quick)
@given(life=lives, first=orders, second=orders, left_first=st.booleans())
def test_merging_is_exact_between_back_ends(life, first, second, left_first, new_place):
    back_ends = ["postgresql", "sqlite", "sqlite", "postgresql", "sqlite", "postgresql"]
    merging_is_exact(life, first, second, left_first, [new_place(back_end) for back_end in back_ends])


def filled(where: str, robots: str) -> Memory:
    memory = open_memory(where)
    for seq, robot in enumerate(robots):
        memory.contribute(robot, lore((robot, "p", seq)), process="p", seq=seq, task={})
    return memory


def test_counts_say_what_happened(memory, new_place):
    with filled(new_place("sqlite"), "abab") as other:
        assert memory.merge_from(other) == {"added": 4, "already_there": 0, "forgotten": 0}
        assert memory.merge_from(other) == {"added": 0, "already_there": 4, "forgotten": 0}
        memory.forget("a")
        assert memory.merge_from(other) == {"added": 0, "already_there": 2, "forgotten": 2}
        assert other.merge_from(memory) == {"added": 0, "already_there": 2, "forgotten": 2}
        assert content(other) == content(memory)


def test_a_memory_merged_with_itself_stays(where):
    with filled(where, "ab") as memory:
        before = content(memory)
        assert memory.merge_from(memory) == {"added": 0, "already_there": 2, "forgotten": 0}
        assert memory.merge_from(where) == {"added": 0, "already_there": 2, "forgotten": 0}
        assert content(memory) == before


@pytest.mark.slow
def test_ties_of_the_clock_fall_alike_everywhere(new_place, monkeypatch):
    """Equal stamps are settled by the robots' names byte by byte, whatever the server's language."""
    monkeypatch.setattr("lifelore.memory.ledger.time.time_ns", lambda: 1)
    robots = ["B", "a", "Z", "ä", "é", "_", "ab", "a b"]
    parts = [open_memory(new_place("sqlite")) for _ in robots]
    for value, (part, robot) in enumerate(zip(parts, robots, strict=True)):
        newest = Record("k", "newest", 1, "newest", np.array([1]), np.array([value]))
        part.contribute(robot, [newest], process="p", seq=0, task={})
    for back_end in ("sqlite", "postgresql"):
        for order in (parts, parts[::-1]):
            with open_memory(new_place(back_end)) as memory:
                for part in order:
                    memory.merge_from(part)
                assert memory.recall("k", "newest", 1).values.tolist() == [robots.index(max(robots))]
    for part in parts:
        part.close()


def test_a_merge_that_fails_changes_nothing(memory, new_place):
    with open_memory(new_place("sqlite")) as other:
        memory.contribute("a", [Record("k", "y", 1, "add", [1], [2**62])], process="p", seq=0, task={})
        other.contribute("b", [Record("k", "y", 1, "add", [2], [5])], process="p", seq=0, task={})
        other.contribute("b", [Record("k", "y", 1, "add", [1], [2**62])], process="p", seq=1, task={})
        before = content(memory)
        with pytest.raises(StoreError, match="64 bits"):
            memory.merge_from(other)
        assert content(memory) == before
    with open_memory(new_place("sqlite")) as other:
        other.contribute("b", [Record("k", "y", 1, "union", [2], [5])], process="p", seq=0, task={})
        with pytest.raises(StoreError, match="add and by union"):
            memory.merge_from(other)
        assert content(memory) == before


def test_a_source_that_does_not_exist_is_not_created(memory, tmp_path):
    with pytest.raises(StoreError, match="does not exist"):
        memory.merge_from(tmp_path / "nowhere.db")
    assert list(tmp_path.iterdir()) == []


def test_a_source_that_holds_no_memory_stays_empty(memory, new_place, back_end):
    place = new_place(back_end)
    if back_end == "sqlite":
        Path(place).touch()
    for _ in range(2):
        with pytest.raises(StoreError, match="holds no Lifelore memory"):
            memory.merge_from(place)


@pytest.mark.slow
def test_many_at_once_count_as_they_would_one_by_one(new_place, back_end):
    """The same memory twice, the receiving one among the sources, one robot's task in two of them, a tombstone."""
    sources = [new_place("sqlite") for _ in range(3)]
    for source, robots in zip(sources, ("ab", "ba", "bb"), strict=True):
        filled(source, robots).close()
    with open_memory(sources[2]) as last:
        last.forget("b")
    here, there = new_place(back_end), new_place(back_end)
    with filled(here, "ä") as one, filled(there, "ä") as many:
        one.merge_from(many)  # The same task twice: both keep the one of the smaller stamp.
        many.merge_from(one)
        order = [sources[0], sources[0], None, sources[1], sources[2], sources[0]]
        counts = many.merge_many([there if place is None else place for place in order])
        assert counts == [one.merge_from(here if place is None else place) for place in order]
        assert [sum(each.values()) for each in counts] == [2, 2, 3, 2, 2, 2]
        assert counts[4] == {"added": 0, "already_there": 0, "forgotten": 2}
        assert content(many) == content(one)
        assert many.check() == []


def test_no_source_at_all_changes_nothing(memory):
    before = content(memory)
    assert memory.merge_many([]) == []
    assert content(memory) == before


def damaged(place: str) -> None:
    with sqlite3.connect(place) as conn:
        conn.execute("UPDATE lifelore_contributions SET digest = 'no' WHERE seq = 1")
    conn.close()


def of_another_program(place: str) -> None:
    Path(place).write_bytes(b"no memory at all" * 100)


def merging_otherwise(place: str) -> None:
    with open_memory(place) as memory:
        memory.contribute("z", [Record("k", "own", 1, "union", [2], [5])], process="p", seq=0, task={})


@pytest.mark.slow
@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (damaged, "SHA-256"),
        (of_another_program, "not a Lifelore memory"),
        (lambda place: Path(place).unlink(), "does not exist"),
        (merging_otherwise, "is merged by add and by union"),
    ],
)
def test_one_bad_source_among_many_refuses_all_by_its_name(memory, new_place, spoil, message):
    places = [new_place("sqlite") for _ in range(4)]
    for place in places:
        with open_memory(place) as source:
            for seq in range(3):
                source.contribute("a", lore(("a", "p", seq)), process=place, seq=seq, task={})
    spoil(places[2])
    memory.contribute("own", [Record("k", "own", 1, "add", [2], [5])], process="p", seq=0, task={})
    before = content(memory)
    with pytest.raises(StoreError, match=message) as refused:
        memory.merge_many(places)
    assert [place in str(refused.value) for place in places] == [False, False, True, False]
    assert "\n" not in str(refused.value)
    assert content(memory) == before
    assert memory.check() == []


KILLED = """
import os, signal, sys
from lifelore.memory import cache, open_memory
written = cache.write
def killed(conn, folded):
    written(conn, folded)
    os.kill(os.getpid(), signal.SIGKILL)
cache.write = killed
with open_memory(sys.argv[1]) as memory:
    memory.merge_many(sys.argv[2:])
"""


@pytest.mark.slow
def test_a_kill_in_the_middle_leaves_the_memory_as_it_was(where, new_place):
    """Killed after all contributions and the first key's cells were written, just before the rest."""
    sources = [new_place("sqlite") for _ in range(2)]
    for source, robots in zip(sources, ("ab", "bä"), strict=True):
        filled(source, robots).close()
    with filled(where, "a") as memory:
        before = content(memory)
        command = [sys.executable, "-c", KILLED, where, *sources]
        assert subprocess.run(command, check=False, timeout=60).returncode == -signal.SIGKILL
        assert content(memory) == before
        assert memory.check() == []
        assert [each["added"] for each in memory.merge_many(sources)] == [1, 2]
