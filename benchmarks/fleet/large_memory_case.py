"""A memory that holds a prior of many contexts, and what a new process pays for opening, reading and writing it.

Run as a program, it measures one memory in a process of its own and prints JSON.
"""

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

import numpy as np

from lifelore.action.priors.action_prior import KIND, VERSION, ActionPrior
from lifelore.core.protocols import Record
from lifelore.core.streams import stream
from lifelore.memory import Memory, open_memory

ACTIONS = 4
"""Actions, or types, of a context."""
COUNTED = 2
"""Actions of each context that have a count."""
PART = 500_000
"""Contexts of a contribution while a memory is filled; more need more main memory."""
TASK_CONTEXTS = 155
"""Contexts that a task counts: those of a task in a generated office."""
READS = 50
KEY = "large"
STEP = 1_000_003
"""Distance of two contexts' codes, so that contexts lie scattered over 64 bits."""


def fill(path: Path, contexts: int, counted: int = COUNTED) -> None:
    """Make a memory whose prior has counted some actions in each of many contexts.

    Each contribution brings a range of contexts of its own, as those of robots in different places do.
    """
    random = stream(0, "bench", "large memory", contexts, counted)
    with open_memory(path) as memory:
        for seq, first in enumerate(range(0, contexts, PART)):
            codes = STEP * np.arange(first, min(first + PART, contexts))
            chosen = random.permuted(np.tile(np.arange(ACTIONS) < counted, (len(codes), 1)), axis=1)
            context, action = np.nonzero(chosen)
            values = random.integers(1, 1 << 24, len(context))
            slots = codes[context] * ACTIONS + action
            memory.contribute("filler", [_record(slots, values)], process="bench", seq=seq, task={})


def _record(slots: np.ndarray, values: np.ndarray) -> Record:
    return Record(KIND, KEY, VERSION, "add", slots, values)


def probed(path: Path, contexts: int, whole: bool) -> dict[str, float]:
    """`probe` in a new process."""
    command = [sys.executable, "-m", __spec__.name, str(path), str(contexts), str(int(whole))]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout)


def probe(path: Path, contexts: int, whole: bool) -> dict[str, float]:
    """Costs in this process; seconds are those of its processor, with the file in the system's cache.

    Returns
    -------
    dict
        ``open``, ``recall``, ``take``, ``contribute``: seconds of opening, of reading one context, of taking a
        task and of contributing one (the last three: medians). ``read_bytes``: bytes read for opening.
        ``open_bytes``: main memory that grew by all this. With `whole` also ``load``, ``load_bytes``: seconds of
        reading the whole prior, and the main memory that this needed at most.
    """
    random = stream(0, "bench", "large memory", "probe", contexts)
    asked = STEP * random.choice(contexts, READS)
    ActionPrior(ACTIONS).sample(
        asked, np.random.default_rng(0)
    )  # imported and compiled before anything is measured
    before, read = _resident(), _bytes_read()
    started = time.process_time()
    with open_memory(path) as memory:
        found = {"open": time.process_time() - started, "read_bytes": _bytes_read() - read}
        found["recall"] = _median(lambda i: _recall(memory, int(asked[i])))
        found |= _writes(memory, contexts)
        found["open_bytes"] = _resident() - before
        if whole:
            started = time.process_time()
            record = memory.recall(KIND, KEY, VERSION)
            assert record is not None, "the memory has been filled"
            prior = ActionPrior.from_record(record, ACTIONS)
            found |= {"load": time.process_time() - started, "load_bytes": _peak() - before}
            assert len(prior) == contexts
    return found


def _recall(memory: Memory, code: int) -> None:
    record = memory.recall(KIND, KEY, VERSION, slots=(code * ACTIONS, code * ACTIONS + ACTIONS - 1))
    assert record is not None
    assert len(record.slots), "the context has been counted"


def _writes(memory: Memory, contexts: int) -> dict[str, float]:
    """Seconds of taking a task and of contributing one, whose contexts lie anywhere among all."""
    random, process = stream(0, "bench", "large memory", "tasks", contexts), f"{os.getpid()}"
    taken: list[int] = []
    take = _median(lambda i: taken.append(memory.take_task("robot", process=process)))

    def contribute(i: int) -> None:
        codes = STEP * np.unique(random.choice(contexts, TASK_CONTEXTS))
        record = _record(codes * ACTIONS, np.ones(len(codes), np.int64))
        memory.contribute("robot", [record], process=process, seq=i, task={"index": taken[i]}, taken=taken[i])

    return {"take": take, "contribute": _median(contribute)}


def _median(run: Callable[[int], object]) -> float:
    times = []
    for i in range(READS):
        started = time.process_time()
        run(i)
        times.append(time.process_time() - started)
    return median(times)


def _resident() -> int:
    """Bytes of main memory of this process now."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def _peak() -> int:
    """Most bytes of main memory that this program has had; `getrusage` would count the program that started it."""
    status = Path("/proc/self/status").read_text(encoding="utf-8")
    return 1024 * int(status.partition("VmHWM:")[2].split()[0])


def _bytes_read() -> int:
    """Bytes that this process has read from files so far, also from the system's cache."""
    return int(Path("/proc/self/io").read_text(encoding="ascii").split()[1])


if __name__ == "__main__":
    print(json.dumps(probe(Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3] == "1")))
