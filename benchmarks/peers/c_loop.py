"""The C twin: built by gcc when it is needed, into a folder that is gone afterwards."""

import ctypes
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.lattice import Case, new_case, run_kernel, timed
from lifelore.core.errors import InputError

SOURCE = Path(__file__).with_name("q_learning.c")
FLAGS = ("-O3", "-march=native", "-ffp-contract=off", "-shared", "-fPIC")
"""Contraction rounds a product and a sum once instead of twice: as fast here, but other bits."""

_SIZES = ("n_states", "n_actions", "n_outcomes", "n_starts", "n_classes", "n_episodes", "max_steps")
_ARRAYS = (
    *("next_state", "reward", "event", "outcome_cum", "starts"),
    *("q_row", "context_row", "reward_class", "explore_cum", "tie_weight", "epsilon", "alpha"),
    *("q", "visits", "world", "own", "returns", "rewards", "steps", "collisions", "reached"),
)


class _Work(ctypes.Structure):
    """As `work` in the C source, field for field."""

    _fields_ = (
        *((name, ctypes.c_int64) for name in _SIZES),
        ("discount", ctypes.c_double),
        *((name, ctypes.c_void_p) for name in _ARRAYS),
    )


class CLoop:
    """The compiled twin, ready to run."""

    def __init__(self, library: ctypes.CDLL) -> None:
        self._learn = library.learn
        self._learn.restype = ctypes.c_int64

    def run(self, case: Case) -> int:
        """Learn all episodes of `case` in place, from the first one on; returns the number of steps."""
        tables, rows, schedule, learner, curve = case
        sizes = (*tables.next_state.shape, tables.starts.size, rows.context_row.shape[1], schedule.epsilon.size)
        arrays = (*tables, *rows, schedule.epsilon, schedule.alpha, *learner[:4], *curve)
        pointers = (array.ctypes.data for array in arrays)
        return self._learn(ctypes.byref(_Work(*sizes, schedule.max_steps, schedule.discount, *pointers)))

    def rate(self) -> float:
        """Million steps a second, over fresh learners."""
        return timed(self.run)


def built_c_loop() -> CLoop | None:
    """The twin, or None where there is no gcc.

    Raises
    ------
    InputError
        gcc cannot build it, or it does not give the kernel's bits, so that a ratio would mean nothing.
    """
    compiler = shutil.which("gcc")
    if compiler is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        binary = Path(folder) / "q_learning.so"
        done = subprocess.run(
            [compiler, *FLAGS, str(SOURCE), "-o", str(binary)], capture_output=True, text=True, check=False
        )
        if done.returncode:
            reason = (done.stderr.strip().splitlines() or ["no reason given"])[0]
            raise InputError(f"gcc must build {SOURCE.name}, got '{reason}'; take gcc off PATH to go without")
        loop = CLoop(ctypes.CDLL(str(binary)))
    _check_same_bits(loop)
    return loop


def _check_same_bits(loop: CLoop) -> None:
    ours, theirs = new_case(200), new_case(200)
    steps = run_kernel(ours), loop.run(theirs)
    learnt = zip((*ours.learner[:4], *ours.curve), (*theirs.learner[:4], *theirs.curve), strict=True)
    if steps[0] != steps[1] or not all(np.array_equal(a, b) for a, b in learnt):
        raise InputError(
            "the C loop must give the kernel's bits, got others: a ratio of unlike work means nothing"
        )
