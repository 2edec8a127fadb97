"""Leases: different tasks for different processes, and the tasks of the dead are taken again."""

import os
import subprocess
import sys
import time

import pytest

from lifelore.core.errors import InputError
from lifelore.memory import leases, open_memory


def finish(memory, number: int, process: str, seq: int) -> bool:
    return memory.contribute("rosie", [], process=process, seq=seq, task={"index": number}, taken=number)


def held(memory) -> list[tuple[int, str]]:
    with memory._store.reading() as conn:
        rows = conn.execute("SELECT number, process FROM lifelore_leases ORDER BY robot, number")
        return [tuple(row) for row in rows]


def test_a_single_process_counts_as_before(memory):
    for number in range(3):
        assert memory.take_task("rosie", process="p") == number == memory.tasks("rosie")
        assert finish(memory, number, "p", number)
    memory.contribute("rosie", [], process="q", seq=0, task={})  # a contribution without a lease counts too
    assert memory.take_task("rosie", process="p") == 4


def test_processes_of_one_robot_take_different_tasks(memory):
    assert [memory.take_task("rosie", process=name) for name in "abc"] == [0, 1, 2]
    assert memory.take_task("karl", process="a") == 0
    assert finish(memory, 1, "b", 0)
    assert memory.take_task("rosie", process="b") == 3
    assert held(memory) == [(0, "a"), (0, "a"), (2, "c"), (3, "b")]
    assert memory.check() == []


def test_a_task_given_back_is_the_next(memory):
    assert [memory.take_task("rosie", process=name) for name in "abc"] == [0, 1, 2]
    memory.give_back_task("rosie", 1, process="c")  # which is another's, so nothing happens
    memory.give_back_task("rosie", 1, process="b")
    assert finish(memory, 2, "c", 0)
    assert [memory.take_task("rosie", process="c") for _ in range(2)] == [1, 3]


def test_an_error_gives_the_task_back(memory):
    with pytest.raises(InterruptedError), memory.taken_task("rosie", process="a") as number:
        raise InterruptedError
    assert (number, memory.take_task("rosie", process="b")) == (0, 0)


def test_after_its_time_a_task_is_taken_again_and_stored_once(memory, monkeypatch):
    assert memory.take_task("rosie", process="slow", seconds=60) == 0
    assert memory.take_task("rosie", process="next", seconds=60) == 1
    now = time.time_ns()
    monkeypatch.setattr(leases.time, "time_ns", lambda: now + 61 * 10**9)
    assert memory.take_task("rosie", process="other", seconds=60) == 0
    assert not finish(memory, 0, "slow", 0)
    assert finish(memory, 0, "other", 0)
    # Nobody has taken this task over, so its time is of no account.
    assert finish(memory, 1, "next", 0)
    assert (memory.tasks("rosie"), held(memory)) == (2, [])


def test_forgetting_a_robot_ends_its_leases(memory):
    assert finish(memory, memory.take_task("rosie", process="a"), "a", 0)
    assert memory.take_task("rosie", process="a") == 1
    memory.forget("rosie")
    assert not finish(memory, 1, "a", 1)
    assert (memory.tasks("rosie"), memory.take_task("rosie", process="a")) == (0, 0)


def test_exports_and_merges_leave_leases_out(memory, tmp_path):
    memory.take_task("rosie", process="a")
    memory.export_to(tmp_path / "export.db")
    with open_memory(tmp_path / "other.db") as other:
        other.merge_from(memory)
        other.merge_from(tmp_path / "export.db")
        assert held(other) == []


TAKER = """
import sys
from lifelore.memory import open_memory
with open_memory(sys.argv[1]) as memory:
    print(memory.take_task("rosie", process="mortal"), flush=True)
    sys.stdin.read()
"""


@pytest.mark.slow
def test_the_task_of_a_killed_process_is_taken_again(where):
    with open_memory(where) as memory:
        taker = subprocess.Popen(
            [sys.executable, "-c", TAKER, where], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        with taker:
            assert taker.stdout.readline() == "0\n"
            assert memory.take_task("rosie", process="a") == 1  # the process lives, so its task is its own
            taker.kill()
            # The dead process is not yet waited for: a zombie is no process at work.
            os.waitid(os.P_PID, taker.pid, os.WEXITED | os.WNOWAIT)
            assert memory.take_task("rosie", process="b") == 0
        assert memory.take_task("rosie", process="c") == 2


def test_who_is_alive():
    mine = leases.holder_of_this_process()
    where, pid, started = mine.rsplit(" ", 2)
    assert not leases.has_died(mine)
    assert leases.has_died(f"{where} {pid} {int(started) - 1}")  # an earlier process of the same number
    assert not leases.has_died(f"another machine {pid} {int(started) - 1}")


def test_without_proc_only_the_time_counts(monkeypatch):
    monkeypatch.setattr(leases, "machine", lambda: None)
    assert leases.holder_of_this_process().startswith("unknown ")
    assert not leases.has_died("unknown 1 ended")


def test_names_and_times_are_checked(memory):
    for changes in ({"robot": ""}, {"process": "a\n"}, {"seconds": 0}):
        with pytest.raises(InputError, match=next(iter(changes))):
            memory.take_task(**{"robot": "rosie", "process": "p"} | changes)
