"""`bench log`: processor time of `lifelore reuse fit` on logs of 100,000 and of a million lines.

The logs are generated: users of three types, twenty lines each, policies drawn at random, normal outcomes. Types
differ by less than the noise, so that finding them takes many iterations. The time includes reading and checking
the lines, finding the types, and writing the study and its users to memory.
"""

import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.rounds import at_most, interleaved, paired_ratio, row
from lifelore.agent.reuse.fit import fit
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.memory import open_memory

LINES = (100_000, 1_000_000)
"""Lines of the short and of the long log."""
LINES_PER_USER, TYPES, POLICIES = 20, 3, 6
SPREAD, NOISE = 1.0, 2.0
"""Standard deviations of the means over types and policies, and of the outcomes of one type and policy."""
GOAL = 30.0
"""Seconds of processor time for the long log."""


def bench_log(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    done = 0

    def after(label: str) -> None:
        nonlocal done
        done += 1
        progress(done, repeats * len(LINES), label)

    with TemporaryDirectory() as folder:
        times = interleaved({f"fit of {n:,} lines": _fits(Path(folder), n) for n in LINES}, repeats, after)
    short, long = times
    growth = paired_ratio(times[long], times[short])
    return {
        "rows": [row(short, median(times[short]), "s"), row(long, median(times[long]), "s", short, growth)],
        "goals": [at_most(f"{long}, s", GOAL, median(times[long]))],
    }


def _fits(folder: Path, n: int) -> Callable[[], float]:
    """Seconds of processor time of a fit of `n` lines to an empty memory."""
    path = folder / f"{n}.csv"
    write_log(path, n)

    def timed() -> float:
        with TemporaryDirectory() as empty, open_memory(Path(empty) / "users.db", durable=True) as memory:
            started = time.process_time()
            fit([path], memory)
            return time.process_time() - started

    return timed


def write_log(path: Path, n: int) -> None:
    """Write a log of `n` lines in random order of the users."""
    draw = stream(0, "bench", "log", n)
    means = draw.normal(0.0, SPREAD, (TYPES, POLICIES))
    n_users = max(n // LINES_PER_USER, 1)
    type_of_user = draw.integers(TYPES, size=n_users)
    users, policies = draw.permutation(np.arange(n) % n_users), draw.integers(POLICIES, size=n)
    outcomes = draw.normal(means[type_of_user[users], policies], NOISE)
    with path.open("w", encoding="utf-8") as file:
        file.write("user,policy,outcome\n")
        columns = zip(users.tolist(), policies.tolist(), outcomes.tolist(), strict=True)
        file.writelines(f"u{user},p{policy},{outcome:.3f}\n" for user, policy, outcome in columns)
