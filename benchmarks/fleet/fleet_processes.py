"""Real processes of robots on one memory: many at the same time, and some that are killed at random moments."""

import random
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from benchmarks.fleet.fleet_audit import task_numbers, wrong_sums
from benchmarks.fleet.fleet_robot import LIFE, LIVES, Robot, command, world_of
from benchmarks.fleet.postgresql_server import postgresql_server
from lifelore.memory import open_memory

PROCESSES, PROCESS_TASKS = 4, 8
"""Robots that run at the same time on one memory, and tasks of each."""
KILLS, KILL_PROCESSES, SECONDS = 10, 3, 0.5
"""Kills, processes of the robot that live at a time, and most seconds between a task of a process and its kill."""


@contextmanager
def memory_on(place: str) -> Iterator[tuple[Path, str | None]]:
    """A folder, and a new memory there or on a server of its own; None if there is no server to live on."""
    with tempfile.TemporaryDirectory() as folder:
        if place == "PostgreSQL":
            with postgresql_server() as server:
                yield Path(folder), server
        else:
            yield Path(folder), str(Path(folder, "fleet.db"))


def processes_on(
    place: str, life: str = LIFE, robots: int | None = None, tasks: int | None = None
) -> dict[str, Any] | None:
    """Robots that live at the same time on one memory; None if there is no server to live on.

    By default `PROCESSES` robots with `PROCESS_TASKS` tasks each.
    """
    robots, tasks = robots or PROCESSES, tasks or PROCESS_TASKS
    with memory_on(place) as (folder, where):
        if where is None:
            return None
        world = world_of(life, folder, 0)
        fleet = [Robot(where, f"robot {i}", i, world) for i in range(robots)]
        running = [subprocess.Popen(command(robot, tasks, life), stdout=subprocess.PIPE) for robot in fleet]
        for process in running:
            process.communicate()
        with open_memory(where) as memory:
            return {
                "robots": robots,
                "tasks": [task_numbers(memory, robot) for robot in memory.robots()],
                "failed": sum(process.returncode != 0 for process in running),
                "problems": memory.check(),
                "wrong_sums": wrong_sums(memory),
            }


def killed_processes(
    place: str = "SQLite", life: str = LIFE, kills: int | None = None, processes: int | None = None
) -> dict[str, Any] | None:
    """Processes of one robot, of which one is killed at random moments; a last process finishes what was lost.

    By default `KILLS` kills of `KILL_PROCESSES` processes; all that are left are killed too. None if there is no
    server to live on.
    """
    draw, kills, processes = random.Random(0), kills or KILLS, processes or KILL_PROCESSES
    with memory_on(place) as (folder, where):
        if where is None:
            return None
        robot = Robot(where, "fleet", 0, world_of(life, folder, 0))
        endless = command(robot, 10**6, life)
        running = [subprocess.Popen(endless, stdout=subprocess.PIPE) for _ in range(processes)]
        try:
            for _ in range(kills):
                victim = running.pop(draw.randrange(len(running)))
                _kill(victim, draw.uniform(0.0, SECONDS))
                running.append(subprocess.Popen(endless, stdout=subprocess.PIPE))
        finally:
            for process in running:
                _kill(process, 0.0)
        with open_memory(robot.memory) as memory:
            before = task_numbers(memory, robot.name)
            problems = memory.check()
        lost = sorted(set(range(max(before, default=-1) + 1)) - set(before))
        LIVES[life](robot, len(lost) + 1, lambda task: None)
        with open_memory(robot.memory) as memory:
            after = task_numbers(memory, robot.name)
            return {
                "kills": kills + processes,
                "tasks": len(after),
                "twice": len(after) - len(set(after)),
                "lost": len(lost),
                "missing": len(set(range(max(after) + 1)) - set(after)),
                "problems": problems + memory.check(),
                "wrong_sums": wrong_sums(memory),
            }


def _kill(process: subprocess.Popen, seconds: float) -> None:
    """Kill a process some time after its first task, so that each kill meets a robot at work."""
    assert process.stdout is not None, "the process prints to a pipe"
    process.stdout.readline()
    time.sleep(seconds)
    process.send_signal(signal.SIGKILL)
    process.communicate()
