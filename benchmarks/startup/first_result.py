"""Time to the first result in a fresh process, imports apart, with a cold and a warm cache of kernels."""

import os
import subprocess
import sys
import tempfile

from lifelore.core.errors import LifeloreError

_Q = """
import time
from lifelore.core.planning.planning import greedy_policy, optimal_q, policy_values
from benchmarks.learners.lattice_case import lattice_task, new_case, run_kernel
started = time.perf_counter()
case = new_case(500)
optimal_q(case.tables, 0.95)
run_kernel(case)
policy_values(case.tables, greedy_policy(case.learner.q), 0.95)
print(time.perf_counter() - started)
"""

_MODEL = """
import time
import numpy as np
from lifelore.core.learning.curve import new_curve
from lifelore.core.learning.known_world import unknown_world, known_policy
from lifelore.core.learning.model_learning import ExplorationStrategy, StateInfo, explore, new_model_learner
from lifelore.core.planning.planning import optimal_q, policy_values
from lifelore.core.streams import stream
from benchmarks.learners.lattice_case import lattice_task
started = time.perf_counter()
tables = lattice_task().tables()
optimal_q(tables, 0.95)
n = tables.n_states
model, explorer = unknown_world(n, 4), new_model_learner(n, 4, stream(0, "world"), stream(0, "own"))
seen = StateInfo(np.zeros(n, np.int64), np.zeros(n, np.int32), np.zeros((1, 4)))
explore(tables, model, seen, ExplorationStrategy(), explorer, new_curve(20), 1000, 0.95, 10**9)
policy_values(tables, known_policy(model, explorer.place), 0.95)
print(time.perf_counter() - started)
"""

LEARNERS = {"q": _Q, "model": _MODEL}
"""What a first result is: the lattice enumerated, solved exactly, learnt, and what was learnt evaluated."""


def first_result_seconds(learner: str) -> tuple[float, float]:
    """Seconds to the first result with an empty cache, and again with the cache it left."""
    with tempfile.TemporaryDirectory() as folder:
        cold, warm = (_timed_inside(LEARNERS[learner], folder) for _ in range(2))
    return cold, warm


def _timed_inside(source: str, cache: str) -> float:
    environment = os.environ | {"NUMBA_CACHE_DIR": cache}
    return float(_run([sys.executable, "-c", source], environment))


def _run(command: list[str], environment: dict[str, str]) -> str:
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        reason = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise LifeloreError(f"a timed process must end well, got '{reason}'")
    return done.stdout
