"""Bytes of learners and of contexts of a prior; large memory files; many memories merged, beside one by one.

Seconds are those of the processor, so that other programs count little. Files lie in the system's cache. Each
large file is opened, read and written in a new process: single contexts are recalled, tasks with contexts anywhere
in the file are contributed, and the whole prior is loaded. Types take the place of actions in a prior over types.
"""

import os
import shutil
import tempfile
import time
import tracemalloc
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import TypeVar

import numpy as np

from benchmarks.lattice import lattice_task
from benchmarks.process import measured_inside
from benchmarks.rounds import Part, at_most, counted, interleaved, joined, row, row_beside
from lifelore.action.priors.action_prior import KIND, VERSION, ActionPrior
from lifelore.core.errors import LifeloreError
from lifelore.core.learning.curve import Curve, new_curve
from lifelore.core.learning.q_learning import QLearner, new_learner
from lifelore.core.protocols import Progress, Record
from lifelore.core.streams import stream
from lifelore.memory import Memory, open_memory

LEARNERS = (1, 10, 100, 1_000, 10_000)
CONTEXTS = (1_000, 10_000, 100_000, 1_000_000, 10_000_000)
"""Numbers of Q-learners, and of contexts in main memory and in a file."""
MOST_READ, MOST_OPEN = 1.0, 0.05
"""Goals of the largest file: megabytes read and seconds needed to open it."""
ROBOTS, TASKS = 100, 30
"""Memories that are merged, and tasks in each."""
PRIOR_SLOTS, TRANSITIONS, FIRST_TASK = 155, 9100, 7700
"""Slots of the shared prior that a task adds to; moves of a building, and those met in the first task."""
MOST_MERGE = 3.0
"""Most seconds of merging all memories in one call."""
_ALL = f"{ROBOTS} memories of {TASKS} tasks"
MANY, SINGLY, REBUILD = f"{_ALL}, many in one call", f"{_ALL}, one by one", f"{_ALL}, rebuild alone"
EPISODES = 100
"""Episodes of a learner whose course is kept."""
ACTIONS, COUNTED, ALPHA0 = 4, 2, 0.1
"""Actions of a context, those of them that a file has counted, and the prior's pseudo-count."""
PART = 500_000
"""Contexts of a contribution while a file is filled; more need more main memory."""
READS = 50
KEY = "large"
STEP = 1_000_003
"""Distance of two contexts' codes, so that contexts lie scattered over 64 bits."""
_PROBE = """
import json, sys
from benchmarks.memory import probe
print(json.dumps(probe(sys.argv[1], int(sys.argv[2]), sys.argv[3] == "True")))
"""
T = TypeVar("T")


def bench_memory(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    after = counted(progress, len(LEARNERS) + len(CONTEXTS) * (2 + repeats) + ROBOTS + 3 * repeats)
    return joined(_sizes(after), _files(repeats, after), _merges(repeats, after))


# ---- in main memory ------------------------------------------------------------------------------------------


def bytes_of(make: Callable[[], T]) -> tuple[T, int]:
    """The object made, and the bytes that Python and NumPy hold for it."""
    tracemalloc.start()
    try:
        before, _ = tracemalloc.get_traced_memory()
        made = make()
        after, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    return made, after - before


def _sizes(after: Callable[[str], None]) -> Part:
    """Bytes of learners and of contexts by number, and of one more."""
    rows = []
    for many, one, make, numbers in (
        ("Q-learners", "Q-learner", learners, LEARNERS),
        ("contexts", "context", prior_of, CONTEXTS),
    ):
        make(1)  # compiled, and what all share is made, before bytes are counted
        sizes = {}
        for n in numbers:
            _, sizes[n] = bytes_of(lambda n=n, make=make: make(n))
            rows.append(row(f"{many}, {n:,}: memory", sizes[n] / 1e6, "MB"))
            after(f"{n:,} {many}")
        rows.append(row(f"a {one} more: memory", slope_of(sizes), "B"))
    return rows, []


def slope_of(measured: Mapping[int, float]) -> float:
    """The increase a piece between the two largest numbers measured."""
    *_, less, more = sorted(measured)
    return (measured[more] - measured[less]) / (more - less)


def learners(n: int) -> list[tuple[QLearner, Curve]]:
    """`n` Q-learners of the 23×23 lattice, each with a table, random streams and a curve of its own."""
    tables = lattice_task().tables()
    world, own = (stream(0, "bench", "capacity", name) for name in ("world", "own"))
    return [(new_learner(tables.n_states, tables.n_actions, world, own), new_curve(EPISODES)) for _ in range(n)]


def prior_of(n: int) -> ActionPrior:
    """A prior that has counted actions in each of `n` scattered contexts, with what it builds to look them up."""
    codes, prior = STEP * np.arange(n), ActionPrior(ACTIONS, ALPHA0)
    prior.update(codes, np.tile(np.arange(ACTIONS) < COUNTED, (n, 1)))
    prior.sample(codes, np.random.default_rng(0))
    return prior


# ---- files -----------------------------------------------------------------------------------------------


def _files(repeats: int, after: Callable[[str], None]) -> Part:
    """Rows of a file of each size, and the goals of the largest."""
    rows, sizes, found = [], {}, {}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "large.db"
        for n in CONTEXTS:
            path.unlink(missing_ok=True)
            fill(path, n)
            sizes[n] = path.stat().st_size
            after(f"{n:,} contexts filled")
            rounds = []
            for number in range(repeats):
                rounds.append(measured_inside(_PROBE, path, n, number == 0))
                after(f"{n:,} contexts in a file")
            found = {name: median(each[name] for each in rounds if name in each) for name in rounds[0]}
            rows += _file_rows(n, sizes[n], found)
    rows.append(row(f"a context more ({COUNTED} actions counted): file", slope_of(sizes), "B"))
    most = f"a memory of {max(CONTEXTS):,} contexts"
    return rows, [
        at_most(f"MB read to open {most}", MOST_READ, found["read_bytes"] / 1e6),
        at_most(f"seconds to open {most}", MOST_OPEN, found["open"]),
    ]


def _file_rows(n: int, size: int, found: Mapping[str, float]) -> list[dict]:
    of = f"{n:,} contexts"
    return [
        row(f"{of}: file", size / 1e6, "MB"),
        row(f"{of}: open", 1e3 * found["open"], "ms"),
        row(f"{of}: read to open", found["read_bytes"] / 1e6, "MB"),
        row(f"{of}: recall one context", 1e6 * found["recall"], "µs"),
        row(f"{of}: take a task", 1e3 * found["take"], "ms"),
        row(f"{of}: contribute a task of {PRIOR_SLOTS} contexts", 1e3 * found["contribute"], "ms"),
        row(f"{of}: load all", found["load"], "s"),
        row(f"{of}: most main memory to load all", found["load_bytes"] / 1e6, "MB"),
    ]


def fill(path: Path, contexts: int) -> None:
    """Make a memory whose prior has counted `COUNTED` actions in each of many contexts.

    Each contribution brings a range of contexts of its own, as those of robots in different places do.
    """
    random = stream(0, "bench", "large memory", contexts, COUNTED)
    with open_memory(path) as memory:
        for seq, first in enumerate(range(0, contexts, PART)):
            codes = STEP * np.arange(first, min(first + PART, contexts))
            chosen = random.permuted(np.tile(np.arange(ACTIONS) < COUNTED, (len(codes), 1)), axis=1)
            context, action = np.nonzero(chosen)
            values = random.integers(1, 1 << 24, len(context))
            record = Record(KIND, KEY, VERSION, "add", codes[context] * ACTIONS + action, values)
            memory.contribute("filler", [record], process="bench", seq=seq, task={})


def probe(path: Path | str, contexts: int, whole: bool) -> dict[str, float]:
    """Costs in this process; seconds are those of its processor.

    Returns
    -------
    dict
        ``open``, ``recall``, ``take``, ``contribute``: seconds of opening, of reading one context, of taking a
        task and of contributing one (the last three: medians). ``read_bytes``: bytes read for opening.
        With `whole` also ``load``, ``load_bytes``: seconds of reading the whole prior, and the main memory that
        this needed at most.
    """
    asked = STEP * stream(0, "bench", "large memory", "probe", contexts).choice(contexts, READS)
    # Imported and compiled before anything is measured.
    ActionPrior(ACTIONS).sample(asked, np.random.default_rng(0))
    before, read, started = _kilobytes("VmRSS"), _bytes_read(), time.process_time()
    with open_memory(path) as memory:
        found = {"open": time.process_time() - started, "read_bytes": float(_bytes_read() - read)}
        found["recall"] = _median(lambda i: _recall(memory, int(asked[i])))
        found |= _writes(memory, contexts)
        if whole:
            started = time.process_time()
            record = memory.recall(KIND, KEY, VERSION)
            assert record is not None, "the memory has been filled"
            prior = ActionPrior.from_record(record, ACTIONS)
            found["load"] = time.process_time() - started
            found["load_bytes"] = 1024.0 * (_kilobytes("VmHWM") - before)
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
        codes = STEP * np.unique(random.choice(contexts, PRIOR_SLOTS))
        record = Record(KIND, KEY, VERSION, "add", codes * ACTIONS, np.ones(len(codes), np.int64))
        memory.contribute("robot", [record], process=process, seq=i, task={"index": taken[i]}, taken=taken[i])

    return {"take": take, "contribute": _median(contribute)}


def _median(run: Callable[[int], object]) -> float:
    times = []
    for i in range(READS):
        started = time.process_time()
        run(i)
        times.append(time.process_time() - started)
    return median(times)


def _kilobytes(line: str) -> int:
    """Main memory of this program now (VmRSS) or at most (VmHWM); `getrusage` would count its parent's peak."""
    status = Path("/proc/self/status").read_text(encoding="utf-8")
    return int(status.partition(f"{line}:")[2].split()[0])


def _bytes_read() -> int:
    """Bytes that this process has read from files so far, also from the system's cache."""
    return int(Path("/proc/self/io").read_text(encoding="ascii").split()[1])


# ---- merging ---------------------------------------------------------------------------------------------


def _merges(repeats: int, after: Callable[[str], None]) -> Part:
    """Memories of robots of one building merged in one call, beside one by one, and rebuilt alone."""
    with tempfile.TemporaryDirectory() as folder:
        sources = []
        for robot in range(ROBOTS):
            sources.append(robot_memory(Path(folder, f"robot{robot}.db"), robot))
            after("robots live")
        contenders = {
            MANY: lambda: merge_seconds(sources, many=True),
            SINGLY: lambda: merge_seconds(sources, many=False),
            REBUILD: lambda: merge_seconds(sources, many=True, rebuilt=True),
        }
        times = interleaved(contenders, repeats, after)
    rows = [row_beside(MANY, times, "s"), *(row_beside(name, times, "s", MANY) for name in (SINGLY, REBUILD))]
    return rows, [at_most("seconds, many in one call", MOST_MERGE, rows[0]["value"])]


def robot_memory(path: Path, robot: int) -> Path:
    """The memory of one robot at `path`: in each task it adds to the prior and stores moves that it met first."""
    generator = stream(0, "bench merge", robot)
    met = generator.permutation(TRANSITIONS)
    later = np.linspace(min(FIRST_TASK, TRANSITIONS), TRANSITIONS, TASKS).astype(np.int64)
    with open_memory(path) as memory:
        for task, part in enumerate(np.split(met, later[:-1])):
            slots = np.sort(generator.permutation(PRIOR_SLOTS + 15)[:PRIOR_SLOTS])
            weights, found = (generator.integers(1 << 24, size=n) for n in (PRIOR_SLOTS, len(part)))
            records = [
                Record("action_prior", "building", 1, "add", slots, weights),
                Record("transitions", "building", 1, "newest", np.sort(part), found),
            ]
            memory.contribute(f"robot {robot}", records, process=f"{robot}", seq=task, task={"index": task})
    return path


def merge_seconds(sources: Sequence[Path], *, many: bool, rebuilt: bool = False) -> float:
    """Processor seconds of merging `sources` into an empty memory, or of rebuilding it once they are there.

    Raises
    ------
    LifeloreError
        Contributions are missing afterwards.
    """
    folder = tempfile.mkdtemp()
    try:
        with open_memory(Path(folder, "fleet.db")) as fleet:
            started = time.process_time()
            counts = fleet.merge_many(sources) if many else [fleet.merge_from(source) for source in sources]
            if rebuilt:
                started = time.process_time()
                fleet.rebuild()
            seconds = time.process_time() - started
    finally:
        shutil.rmtree(folder)
    if (added := sum(each["added"] for each in counts)) != len(sources) * TASKS:
        raise LifeloreError(f"a merge must bring {len(sources) * TASKS} contributions, got {added}")
    return seconds
