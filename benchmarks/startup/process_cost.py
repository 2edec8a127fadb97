"""What a whole process of the command line costs, by the clock and in processor time."""

import os
import resource
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from lifelore.core.errors import LifeloreError


class Cost(NamedTuple):
    """Seconds of a process: by the clock, and of all processors (user and system)."""

    wall: float
    cpu: float


def process_cost(arguments: Sequence[object], environment: dict[str, str], status: int = 0) -> Cost:
    """What one process of ``lifelore ARGUMENTS`` costs, from its start to its end with exit status `status`.

    Raises
    ------
    LifeloreError
        The process ends with another exit status.
    """
    command = [sys.executable, "-m", "lifelore.app.command_line", *map(str, arguments)]
    before, began = _children_seconds(), time.perf_counter()
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    cost = Cost(time.perf_counter() - began, _children_seconds() - before)
    if done.returncode != status:
        reason = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise LifeloreError(f"a timed process must end well, got '{reason}'")
    return cost


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


def _children_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
