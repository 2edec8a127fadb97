"""Cells of claim C5.6: how many tasks a trial on a robot needs, and the records of such a trial.

The file of a trial is a CSV with the columns `COLUMNS`: a row for each task and agent, in which the robot did the
first episode of the task. `docs/robot_trial.md` is the protocol.
"""

import csv
import hashlib
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from scipy.stats import nct, t

from lifelore.core.errors import InputError, NotFoundError

COLUMNS = ("task", "agent", "points", "brought", "spills")
"""Task number; agent, one of `AGENTS`; points as in the simulated job; 1 if the target was handed over, else 0;
objects spilled."""
AGENTS = ("full", "scratch", "no-perception", "no-prior")
"""The names of `lifelore live --agent`."""


def cells(settings: Mapping) -> list[dict]:
    """One cell for each size of the effect, and one for the file of a trial, if the settings name it."""
    found: list[dict] = [{"effect": effect} for effect in settings["effects"]]
    if settings["trials"]:
        content = _content(settings["trials"])
        found.append({"trials": settings["trials"], "digest": hashlib.sha256(content).hexdigest()[:16]})
    return found


def check(settings: Mapping) -> None:
    """Refuse a file that is not the record of a trial."""
    if settings["trials"]:
        read_trials(settings["trials"])


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """The power of the trial by number of tasks, or the records of the file; nothing is random."""
    if "trials" in cell:
        return {"trials": read_trials(cell["trials"])}
    return {"effect": cell["effect"], "power": [power(cell["effect"], n) for n in settings["tasks"]]}


def power(effect: float, tasks: int) -> float:
    """Probability that the 95 % interval of a mean of paired differences lies above 0.

    Parameters
    ----------
    effect : float
        True mean of the differences in their standard deviations; the differences are Gaussian.
    tasks : int
        Number of pairs, at least 2.
    """
    bound = t.ppf(0.975, tasks - 1)
    return float(nct.sf(bound, tasks - 1, effect * np.sqrt(tasks)))


def read_trials(path: str) -> list[dict]:
    """The records of a file: ``{"task", "agent", "points", "brought", "spills"}`` each.

    Raises
    ------
    NotFoundError
        There is no such file.
    InputError
        A column is missing, a value breaks its rule, or a task lacks an agent or has it twice.
    """
    rows = list(csv.DictReader(_content(path).decode("utf-8").splitlines()))
    missing = [name for name in COLUMNS if not rows or name not in rows[0]]
    if missing:
        raise InputError(
            f"trials '{path}' must have the columns {', '.join(COLUMNS)}; missing {', '.join(missing)}"
        )
    records = [_record(path, number, row) for number, row in enumerate(rows, start=2)]
    by_task: dict[int, list[str]] = {}
    for record in records:
        by_task.setdefault(record["task"], []).append(record["agent"])
    for task, agents in by_task.items():
        if sorted(agents) != sorted(AGENTS):
            raise InputError(
                f"trials '{path}': task {task} must have each of {', '.join(AGENTS)} once, got {', '.join(agents)}"
            )
    return records


def _record(path: str, line: int, row: Mapping) -> dict:
    try:
        record = {
            "task": int(row["task"]),
            "agent": row["agent"],
            "points": float(row["points"]),
            "brought": int(row["brought"]),
            "spills": int(row["spills"]),
        }
    except (TypeError, ValueError) as error:
        raise InputError(
            f"trials '{path}', line {line}: {error}; write numbers in all columns but agent"
        ) from None
    if not np.isfinite(record["points"]) or record["brought"] not in (0, 1) or record["spills"] < 0:
        raise InputError(
            f"trials '{path}', line {line}: points finite, brought 0 or 1, spills ≥ 0, got {dict(row)}"
        )
    return record


def _content(path: str) -> bytes:
    if not Path(path).is_file():
        raise NotFoundError(f"trials '{path}' is not a file; name a CSV with the columns {', '.join(COLUMNS)}")
    return Path(path).read_bytes()
