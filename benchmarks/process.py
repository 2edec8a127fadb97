"""Processes that are timed: a verb of the command line, or a small program that measures itself."""

import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from lifelore.core.errors import LifeloreError


class Cost(NamedTuple):
    """Seconds of a process: by the clock, and of all processors (user and system)."""

    wall: float
    cpu: float


def process_cost(arguments: Sequence[object], environment: dict[str, str], status: int = 0) -> Cost:
    """Cost of one process of ``lifelore ARGUMENTS``, from its start to its end with exit status `status`.

    Raises
    ------
    LifeloreError
        The process ends with another exit status.
    """
    before, began = _children_seconds(), time.perf_counter()
    _run(["-m", "lifelore.app.command_line", *map(str, arguments)], environment, status)
    return Cost(time.perf_counter() - began, _children_seconds() - before)


def measured_inside(source: str, *arguments: object, environment: dict[str, str] | None = None) -> Any:
    """The JSON value that a Python program prints in a process of its own.

    Raises
    ------
    LifeloreError
        The process does not end well.
    """
    return json.loads(_run(["-c", source, *map(str, arguments)], environment or dict(os.environ), 0))


def cold_and_warm(source: str) -> tuple[float, float]:
    """Seconds that a program prints, with an empty cache of kernels, and again with the cache it left."""
    with TemporaryDirectory() as folder:
        environment = os.environ | {"NUMBA_CACHE_DIR": folder}
        cold, warm = (measured_inside(source, environment=environment) for _ in range(2))
    return cold, warm


def installed_environment(folder: Path, kernels: Path | None = None) -> dict[str, str]:
    """The environment of a process whose modules are kept as bytecode, as in an installed package.

    Parameters
    ----------
    folder : Path
        Bytecode is kept below it.
    kernels : Path, optional
        Folder of compiled kernels; default the user's.
    """
    environment = os.environ | {"PYTHONPYCACHEPREFIX": str(folder / "bytecode")}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    return environment | ({"NUMBA_CACHE_DIR": str(kernels)} if kernels else {})


def _run(arguments: list[str], environment: dict[str, str], status: int) -> str:
    command = [sys.executable, *arguments]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode != status:
        reason = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise LifeloreError(f"a timed process must end well, got '{reason}'")
    return done.stdout


def _children_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
