"""Real processes of robots on one memory: many at the same time, and some that are killed at random moments."""

import random
import signal
import subprocess
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from lifelore.experiments.bench.fleet.fleet_audit import task_numbers, wrong_sums
from lifelore.experiments.bench.fleet.fleet_robot import LIFE, LIVES, Robot, command, office
from lifelore.experiments.bench.fleet.postgresql_server import postgresql_server
from lifelore.memory import open_memory

PROCESSES, PROCESS_TASKS = 4, 8
"""Robots that run at the same time on one memory, and tasks of each."""
KILLS, KILL_PROCESSES, SECONDS = 10, 3, 0.5
"""Kills, processes of the robot that live at a time, and most seconds between a task of a process and its kill."""


def processes_on(place: str) -> dict[str, Any] | None:
    """Robots that live at the same time on one memory; None if there is no server to live on."""
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        where = str(folder / "fleet.db")
        if place == "PostgreSQL":
            server = stack.enter_context(postgresql_server())
            if server is None:
                return None
            where = server
        world = office(folder, 0)
        running = [
            subprocess.Popen(command(Robot(where, f"robot {i}", i, world), PROCESS_TASKS), stdout=subprocess.PIPE)
            for i in range(PROCESSES)
        ]
        for process in running:
            process.communicate()
        with open_memory(where) as memory:
            return {
                "robots": PROCESSES,
                "tasks": [task_numbers(memory, robot) for robot in memory.robots()],
                "failed": sum(process.returncode != 0 for process in running),
                "problems": memory.check(),
                "wrong_sums": wrong_sums(memory),
            }


def killed_processes() -> dict[str, Any]:
    """Processes of one robot, of which one is killed at random moments; a last process finishes what was lost."""
    draw = random.Random(0)
    with tempfile.TemporaryDirectory() as folder:
        robot = Robot(str(Path(folder, "fleet.db")), "fleet", 0, office(Path(folder), 0))
        endless = command(robot, 10**6)
        running = [subprocess.Popen(endless, stdout=subprocess.PIPE) for _ in range(KILL_PROCESSES)]
        try:
            for _ in range(KILLS):
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
        LIVES[LIFE](robot, len(lost) + 1, lambda task: None)
        with open_memory(robot.memory) as memory:
            after = task_numbers(memory, robot.name)
            return {
                "kills": KILLS + KILL_PROCESSES,
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
