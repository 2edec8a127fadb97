"""Learners in threads: how much more work two threads do, and that they learn the same."""

import os
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from benchmarks.learners.lattice_case import Case, new_case, run_kernel
from lifelore.core.errors import LifeloreError

LEARNERS, EPISODES = 8, 1000
THREADS = max(2, min(4, os.cpu_count() or 1))


def threaded_rate(threads: int) -> float:
    """Million steps a second of eight learners on `threads` threads."""
    cases = [new_case(EPISODES, seed) for seed in range(LEARNERS)]
    started = time.perf_counter()
    steps = run_all(cases, threads)
    return steps / (time.perf_counter() - started) / 1e6


def run_all(cases: list[Case], threads: int) -> int:
    """Run all learners in place; returns the number of steps of all."""
    with ThreadPoolExecutor(threads) as pool:
        return sum(pool.map(run_kernel, cases))


def check_same_bits() -> None:
    """Raise unless learners on several threads learn what they learn on one."""
    alone, together = ([new_case(50, seed) for seed in range(LEARNERS)] for _ in range(2))
    run_all(alone, 1)
    run_all(together, THREADS)
    for one, other in zip(alone, together, strict=True):
        if not all(np.array_equal(a, b) for a, b in zip(one.learner, other.learner, strict=True)):
            raise LifeloreError("learners must learn the same on any number of threads, got other bits")
