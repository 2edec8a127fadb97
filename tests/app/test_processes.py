"""Lives as real processes: interrupted, side by side, out of space, and without the right to write."""

import json
import resource
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path

import pytest

from lifelore.memory import open_memory
from tests.app.changed_settings import changed

LATTICE = ("live", "--domain", "lattice")


def sound_tasks(path: Path, robot: str = "robot") -> int:
    """Finished tasks of a robot, after a look at every byte."""
    with open_memory(path) as memory:
        assert memory.check() == []
        return memory.tasks(robot)


def task_indices(path: Path) -> list[int]:
    """Which tasks of the stream are stored, in the order they were."""
    with closing(sqlite3.connect(path)) as conn:
        rows = conn.execute("SELECT task FROM lifelore_contributions ORDER BY number").fetchall()
    return [json.loads(task)["index"] for (task,) in rows]


def test_ctrl_c_keeps_what_is_finished(start, answer, ask, wait_for_tasks, tmp_path):
    memory = tmp_path / "life.db"
    child = start(*LATTICE, "--tasks", 100_000, "--memory", memory, "--json")
    wait_for_tasks(child, memory, 2)
    child.send_signal(signal.SIGINT)
    said = answer(child)
    assert said.status == 130
    (stopping,) = said.err.splitlines()
    assert stopping.startswith("stopping: ")
    life = said.document
    stored = sound_tasks(memory)
    assert stored >= 2
    assert life["memory"] == {"tasks_before": 0, "tasks_after": stored}
    assert [task["index"] for task in life["tasks"]] == list(range(stored)) == task_indices(memory)
    assert life["summary"]["lore_vs_scratch"]["jumpstart"]["n"] == max(1, stored // 3)
    on = ask(*LATTICE, "--tasks", 2, "--memory", memory, "--json").document
    assert on["memory"] == {"tasks_before": stored, "tasks_after": stored + 2}
    assert [task["index"] for task in on["tasks"]] == [stored, stored + 1]


def test_ctrl_c_is_heard_within_a_task(start, answer, ask, tmp_path):
    """The first task alone would take the better part of a minute: no plan leads through 15,000 places."""
    memory = tmp_path / "life.db"
    endless = ("--agent", "undirected", *changed(size=151, max_steps=10**8))
    child = start(*LATTICE, *endless, "--memory", memory, "--json")
    while not memory.exists():
        time.sleep(0.02)
        assert child.poll() is None
    child.send_signal(signal.SIGINT)
    said = answer(child)
    life = said.document
    assert (said.status, life["tasks"], life["summary"]) == (130, [], {})
    assert life["memory"] == {"tasks_before": 0, "tasks_after": 0}
    assert sound_tasks(memory) == 0
    assert ask(*LATTICE, "--tasks", 1, "--memory", memory).status == 0


def test_two_lives_of_one_robot_share_its_tasks(start, answer, tmp_path):
    """Both begin where no memory is yet. Which task is lived by whom is a matter of time."""
    memory = tmp_path / "life.db"
    children = [start(*LATTICE, "--tasks", 5, "--memory", memory, "--json") for _ in range(2)]
    lives = [answer(child) for child in children]
    assert [(life.status, life.err) for life in lives] == [(0, ""), (0, "")]
    assert sound_tasks(memory) == 10
    assert sorted(task["index"] for life in lives for task in life.document["tasks"]) == list(range(10))


def test_a_full_disk_is_one_line_and_keeps_what_is_finished(start, answer, ask, known):
    """Files that may not grow past a limit: write() itself fails, as on a full disk."""
    limit = known.stat().st_size + 150_000
    child = start(
        "live", "--domain", "lattice", "--tasks", 100_000, "--memory", known, "--json",
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
    )  # fmt: skip
    said = answer(child)
    assert (said.status, said.out) == (2, "")
    (line,) = said.err.splitlines()
    assert line.startswith(f"lifelore: memory {known}: ")
    assert "full" in line or "no space" in line
    stored = sound_tasks(known)
    assert stored > 2
    assert task_indices(known) == list(range(stored))
    on = ask(*LATTICE, "--tasks", 1, "--memory", known, "--json").document
    assert on["memory"] == {"tasks_before": stored, "tasks_after": stored + 1}


AS_NOBODY = """
import os, shutil, sys
from lifelore.app.command_line import run
memory, spare, *arguments = sys.argv[1:]
shutil.copy(memory, spare)
with open(os.devnull, "w") as nowhere:
    told, sys.stdout = sys.stdout, nowhere
    assert run([*arguments, "--memory", spare]) == 0  # so that what is read late is read before the rights go
    sys.stdout = told
os.chmod(os.path.dirname(memory), 0o555)
os.chmod(memory, 0o444)
if os.getuid() == 0:
    os.setgid(65534), os.setuid(65534)
sys.exit(run([*arguments, "--memory", memory]))
"""


@pytest.mark.parametrize(
    ("arguments", "reads"),
    [((*LATTICE, "--tasks", "1"), False), (("memory", "show", "--json"), True)],
    ids=["live", "show"],
)
def test_a_read_only_memory_can_be_read(arguments, reads, known, tmp_path, answer):
    shut = tmp_path / "shut"
    shut.mkdir()
    known = known.rename(shut / "known.db")
    for folder in [tmp_path, *tmp_path.parents][:-2]:  # below /tmp; pytest closes its folders to other users
        folder.chmod(0o755)
    before = known.read_bytes()
    command = [sys.executable, "-c", AS_NOBODY, str(known), str(tmp_path / "spare.db"), *arguments]
    said = answer(subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True))
    shut.chmod(0o755)
    if reads:
        assert (said.status, said.document["robots"][0]["tasks"]) == (0, 2)
    else:
        assert "read-only" in said.refusal or "may be read and written" in said.refusal
    assert known.read_bytes() == before
    known.chmod(0o644)
    assert sound_tasks(known) == 2
