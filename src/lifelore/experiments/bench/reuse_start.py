"""Processor seconds of whole processes that choose for one user from the shell, caches warm."""

import csv
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

from lifelore.agent.reuse import choose
from lifelore.agent.reuse_fit import FitSettings, fit
from lifelore.agent.reuse_study import open_study
from lifelore.core.errors import LifeloreError
from lifelore.core.streams import stream
from lifelore.memory import open_memory

USERS, TYPES, POLICIES, OUTCOMES = 60, 4, 6, 8
"""Of the log that is fitted; each user has `OUTCOMES` lines."""
RULE = "information-directed"


def reuse_start_seconds(repeats: int = 5, rule: str = RULE) -> tuple[list[float], list[float]]:
    """Processor seconds of `lifelore reuse choose` and of `lifelore reuse update`, one pair a repeat.

    A study is fitted from a log first. One unmeasured pair warms the caches.
    """
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder, "memory.db")
        write_log(Path(folder, "log.csv"))
        with open_memory(place) as memory:
            fit([Path(folder, "log.csv")], memory, FitSettings(rule=rule))
            study = open_study(memory)
            decisions = [choose(memory, study, "ann")["decision"] for _ in range(repeats + 1)]
        chosen, updated = [], []
        for decision in decisions:
            chosen.append(_seconds("choose", "--user", "ann", "--memory", place))
            updated.append(_seconds("update", "--decision", decision, "--outcome", 1, "--memory", place))
    return chosen[1:], updated[1:]


def write_log(path: Path) -> None:
    """A log of normal outcomes whose users' types it names."""
    generator = stream(0, "bench reuse start")
    means = generator.normal(scale=10, size=(TYPES, POLICIES))
    with path.open("w", newline="") as file:
        lines = csv.writer(file)
        lines.writerow(["user", "policy", "outcome", "type"])
        for user in range(USERS):
            type_ = user % TYPES
            for policy in generator.integers(POLICIES, size=OUTCOMES).tolist():
                outcome = float(generator.normal(means[type_, policy], 3))
                lines.writerow([f"user {user}", f"policy {policy}", outcome, f"type {type_}"])


def _seconds(*arguments: object) -> float:
    command = [sys.executable, "-m", "lifelore.app.command_line", "reuse", *map(str, arguments)]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, env=dict(os.environ), capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        reason = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise LifeloreError(f"a timed process must end well, got '{reason}'")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
