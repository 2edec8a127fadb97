"""The one loop of lives, with a small life: numbers, leases, refresh, stopping, and processes that die."""

import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from threading import Event

import pytest

from lifelore.agent.life.loop import LivedTask, Stopped, opened_memory, run_life
from lifelore.core.errors import StoreError
from lifelore.core.protocols import Record
from lifelore.memory import Memory, open_memory

KEY = ("tally", "marks", 1)


@dataclass
class Marks:
    """Each task adds its number to a tally; `known` is the tally that the agent knows."""

    memory: Memory | None
    known: int = -1
    calls: list = field(default_factory=list)
    before: dict = field(default_factory=dict)
    """What else happens while a task is lived, by number."""

    def recall(self):
        record = self.memory and self.memory.recall(*KEY)
        self.known = int(record.values[0]) if record else 0
        self.calls.append("recall")

    def live(self, number, seq, stop):
        self.calls.append((number, seq, self.known))
        if number in self.before:
            self.before.pop(number)(stop)
        self.known += number
        record = Record(*KEY, "add", slots=[0], values=[number])
        return LivedTask([record], {"index": number}, f"result {number}", "odd" if number % 2 else "")

    def finish(self, lived):
        self.calls.append(lived.result)


@pytest.fixture
def memory(tmp_path):
    with open_memory(tmp_path / "m.db") as opened:
        yield opened


def tally(memory):
    record = memory.recall(*KEY)
    return 0 if record is None else int(record.values[0])


def drop(stop):
    stop.set()
    raise Stopped


def test_each_task_is_lived_stored_and_reported_in_order(memory):
    life, ticks = Marks(memory), []
    run_life(life, 3, memory=memory, progress=lambda *tick: ticks.append(tick))
    assert life.calls == ["recall", (0, 0, 0), "result 0", (1, 1, 0), "result 1", (2, 2, 1), "result 2"]
    assert ticks == [(0, 3, ""), (1, 3, "task 0"), (2, 3, "task 1: odd"), (3, 3, "task 2")]
    assert tally(memory) == 0 + 1 + 2
    assert [task["index"] for task in memory.task_descriptions("robot")] == [2, 1, 0]


def test_the_next_run_goes_on_with_what_is_stored(memory):
    run_life(Marks(memory), 3, memory=memory)
    life = Marks(memory)
    run_life(life, 2, memory=memory)
    assert life.calls == ["recall", (3, 0, 3), "result 3", (4, 1, 6), "result 4"]
    other = Marks(memory)
    run_life(other, 1, memory=memory, robot="other")
    assert other.calls[1] == (0, 0, 10)


def test_without_a_memory_tasks_are_counted_from_0_and_nothing_is_forgotten():
    life = Marks(None)
    run_life(life, 3, memory=None, refresh=True)
    assert life.calls == ["recall", (0, 0, 0), "result 0", (1, 1, 0), "result 1", (2, 2, 1), "result 2"]


@pytest.mark.parametrize(("refresh", "known"), [(False, 0), (True, 100)])
def test_refresh_recalls_what_others_have_stored_before_each_task(memory, refresh, known):
    def another_robot(stop):
        record = Record(*KEY, "add", slots=[0], values=[100])
        memory.contribute("other", [record], process="p", seq=0, task={})

    life = Marks(memory, before={0: another_robot})
    run_life(life, 2, memory=memory, refresh=refresh)
    recalls = ["recall"] * refresh
    assert life.calls == ["recall", (0, 0, 0), "result 0", *recalls, (1, 1, known), "result 1"]


def test_a_task_that_another_process_took_over_is_not_used(memory):
    def lose(stop):
        """The lease ends, and another process lives the task meanwhile."""
        with memory._store.writing() as conn:
            conn.execute("UPDATE lifelore_leases SET until = 0")
        assert memory.take_task("robot", process="other") == 1
        record = Record(*KEY, "add", slots=[0], values=[50])
        assert memory.contribute("robot", [record], process="other", seq=0, task={"index": 1}, taken=1)

    life, lines, ticks = Marks(memory, before={1: lose}), [], []
    run_life(life, 3, memory=memory, notify=lines.append, progress=lambda done, total, label: ticks.append(done))
    assert life.calls == ["recall", (0, 0, 0), "result 0", (1, 1, 0), "recall", (2, 2, 50), "result 2"]
    assert lines == ["task 1 took so long that another process took it over; its result here is not used"]
    assert ticks == [0, 1, 2, 3]
    assert tally(memory) == 0 + 50 + 2


def test_stopping_before_a_task_takes_none(memory):
    life, stop = Marks(memory), Event()
    stop.set()
    run_life(life, 3, memory=memory, stop=stop)
    assert life.calls == ["recall"]
    assert memory.take_task("robot", process="p") == 0


def test_stopping_after_a_task_keeps_it(memory):
    life, stop = Marks(memory, before={1: Event.set}), Event()
    run_life(life, 3, memory=memory, stop=stop)
    assert life.calls[-1] == "result 1"
    assert memory.tasks("robot") == 2


def test_a_stopped_task_is_dropped_and_is_the_next_one(memory):
    life = Marks(memory, before={1: drop})
    run_life(life, 3, memory=memory)
    assert life.calls[-1] == (1, 1, 0)
    assert memory.tasks("robot") == 1
    again = Marks(memory)
    run_life(again, 1, memory=memory)
    assert again.calls[1] == (1, 0, 0)


def test_an_error_gives_the_task_back_and_passes(memory, monkeypatch):
    def fail(stop):
        raise RuntimeError("battery empty")

    with pytest.raises(RuntimeError, match="battery empty"):
        run_life(Marks(memory, before={1: fail}), 3, memory=memory)

    def full(*args, **kwargs):
        raise StoreError("the disk is full")

    with monkeypatch.context() as patch:
        patch.setattr(Memory, "contribute", full)
        with pytest.raises(StoreError, match="full"):
            run_life(Marks(memory), 1, memory=memory)
    assert (memory.tasks("robot"), memory.take_task("robot", process="p")) == (1, 1)


DIES = """
import os, sys
from lifelore.memory import open_memory
from lifelore.agent.life.loop import run_life
from tests.agent.life.test_loop import Marks
with open_memory(sys.argv[1]) as memory:
    run_life(Marks(memory, before={2: lambda stop: os._exit(9)}), 5, memory=memory)
"""


def test_the_task_of_a_killed_process_is_lived_by_the_next(tmp_path):
    root = Path(__file__).parents[3]
    done = subprocess.run([sys.executable, "-c", DIES, str(tmp_path / "m.db")], cwd=root, check=False)
    assert done.returncode == 9
    with open_memory(tmp_path / "m.db") as memory:
        assert memory.tasks("robot") == 2
        life = Marks(memory)
        run_life(life, 3, memory=memory)
        assert [call[0] for call in life.calls if isinstance(call, tuple)] == [2, 3, 4]
        assert tally(memory) == 0 + 1 + 2 + 3 + 4


def test_a_memory_that_is_open_stays_open(memory, tmp_path):
    with opened_memory(memory) as same:
        assert same is memory
    assert memory.tasks("robot") == 0
    with opened_memory(None) as nothing:
        assert nothing is None
    with opened_memory(tmp_path / "other.db") as opened:
        assert opened.location == str(tmp_path / "other.db")
    with pytest.raises(StoreError):
        opened.tasks("robot")
