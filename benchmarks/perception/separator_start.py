"""Time to the first separator in a fresh process, imports apart, with a cold and a warm cache of kernels."""

import os
import subprocess
import sys
import tempfile

from lifelore.core.errors import LifeloreError

_FIRST = """
import time
import numpy as np
from lifelore.perception.separation.separator import separate
cloud = np.random.default_rng(0).uniform(0, 0.1, (4000, 3))
started = time.perf_counter()
found = separate(cloud, cloud + np.array([0.1013, 0, 0]))
found.decision(cloud[:1])
print(time.perf_counter() - started)
"""


def separator_start_seconds() -> tuple[float, float]:
    """Seconds to the first separator with an empty cache, and again with the cache it left."""
    with tempfile.TemporaryDirectory() as folder:
        cold, warm = (_timed_inside(folder) for _ in range(2))
    return cold, warm


def _timed_inside(cache: str) -> float:
    command, environment = [sys.executable, "-c", _FIRST], os.environ | {"NUMBA_CACHE_DIR": cache}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        reason = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise LifeloreError(f"a timed process must end well, got '{reason}'")
    return float(done.stdout)
