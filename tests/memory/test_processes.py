"""Real processes: two that write at once, and one that is killed again and again."""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from lifelore.memory import open_memory

CONTRIBUTOR = Path(__file__).with_name("contributor.py")
HUNG = 600
"""Seconds after which a process counts as hung; only a test that fails waits so long."""
SOAK_KILLS = int(os.environ.get("LIFELORE_SOAK_KILLS", "200"))


def start(where: str, robot: str, tasks: int, slots: int) -> subprocess.Popen[str]:
    command = [sys.executable, str(CONTRIBUTOR), where, robot, str(tasks), str(slots)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.mark.slow
def test_two_processes_on_one_memory_add_up_exactly(where):
    """Both begin on a place where no memory is yet, so they also race to create it."""
    running = [start(where, robot, 40, 500) for robot in ("a", "b")]
    for process in running:
        out, err = process.communicate(timeout=HUNG)
        assert (err, out.split()) == ("", ["ready", *map(str, range(40))])
    with open_memory(where) as memory:
        assert (memory.tasks("a"), memory.tasks("b")) == (40, 40)
        assert memory.recall("counts", "shared", 1).values.tolist() == [80] * 500
        assert memory.check() == []


def kill_once(where: str, seconds: float, slots: int, tasks: int = 0) -> int:
    """Start a contributor and kill it `seconds` after its first `tasks`; how many it acknowledged in all."""
    process = start(where, "victim", 0, slots)
    told = [process.stdout.readline() for _ in range(1 + tasks)]
    time.sleep(seconds)
    process.send_signal(signal.SIGKILL)
    # Not by `communicate`, which would leave out what `readline` has already taken from the pipe.
    told += process.stdout.readlines()
    assert (process.wait(), process.stderr.read()) == (-signal.SIGKILL, "")
    process.stdout.close(), process.stderr.close()
    assert told == ["ready\n", *(f"{seq}\n" for seq in range(len(told) - 1))]
    return len(told) - 1


def kill_loop(where: str, kills: int, longest: float, seed: int) -> None:
    """Each kill loses at most the task in progress: no acknowledged task is missing, at most one is extra.

    Every other kill waits for one task first, so that some are done on any machine; the others may fall into the
    opening.
    """
    draw, slots, before = random.Random(seed), 5000, 0
    for kill in range(kills):
        acknowledged = kill_once(where, draw.uniform(0.0, longest), slots, kill % 2)
        with open_memory(where) as memory:
            # Taking the writers' turn once lets a server settle what the dead client had sent.
            memory.contribute("witness", [], process=f"kill{time.time_ns()}", seq=0, task={})
            tasks = memory.tasks("victim")
            assert tasks - before - acknowledged in (0, 1)
            assert memory.check() == []
            shared = memory.recall("counts", "shared", 1)
            assert shared is None if tasks == 0 else shared.values.tolist() == [tasks] * slots
        before = tasks
    assert before >= kills // 2


# On an idle machine opening takes 10 to 20 ms and a task about 25 ms in SQLite, 100 ms in PostgreSQL, most of it
# inside the transaction: these times end anywhere between "not yet open" and "some tasks done".
@pytest.mark.slow
@pytest.mark.parametrize(("back_end", "kills", "longest"), [("sqlite", 8, 0.15), ("postgresql", 4, 0.6)])
def test_a_kill_loses_at_most_the_task_in_progress(back_end, kills, longest, new_place):
    kill_loop(new_place(back_end), kills, longest, seed=kills)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(5))
def test_a_kill_while_the_memory_is_created(file, seed):
    kill_once(str(file), random.Random(seed).uniform(0.0, 0.02), 10)
    with open_memory(file) as memory:
        assert memory.check() == []


@pytest.mark.soak
def test_soak_kills(new_place):
    """Longer lives than in the suite, so that kills also meet the log being moved into the file."""
    kill_loop(new_place("sqlite"), SOAK_KILLS, 1.0, seed=0)
