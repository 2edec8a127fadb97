"""`bench merge`: memories of many robots of one building merged in one call, beside one by one.

Each robot has lived through `TASKS` tasks. A task adds to the weights of `PRIOR_SLOTS` slots of the shared action
prior. It also stores the transitions that the robot met first: `FIRST_TASK` in the first task and a few later.
Seconds are the processor's, so that a busy machine does not count.
"""

import shutil
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.rounds import Rates, at_most, interleaved, paired_ratio, row
from lifelore.core.errors import LifeloreError
from lifelore.core.protocols import Progress, Record
from lifelore.core.streams import stream
from lifelore.memory import open_memory

ROBOTS, TASKS = 100, 30
PRIOR_SLOTS, TRANSITIONS, FIRST_TASK = 155, 9100, 7700
MOST_SECONDS = 3.0
MANY, SINGLY = "many in one call", "one by one"


def bench_merge(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    total, done = ROBOTS + 3 * repeats, 0

    def after(label: str) -> None:
        nonlocal done
        done += 1
        progress(done, total, label)

    with tempfile.TemporaryDirectory() as folder:
        sources = []
        for robot in range(ROBOTS):
            sources.append(robot_memory(Path(folder, f"robot{robot}.db"), robot))
            after("robots live")
        times = interleaved(
            {
                MANY: lambda: merge_seconds(sources, many=True),
                SINGLY: lambda: merge_seconds(sources, many=False),
                "rebuild": lambda: merge_seconds(sources, many=True, rebuilt=True),
            },
            repeats,
            after,
        )
    return {"rows": _rows(times), "goals": _goals(times)}


def robot_memory(path: Path, robot: int) -> Path:
    """The memory of one robot at `path`."""
    generator = stream(0, "bench merge", robot)
    met = generator.permutation(TRANSITIONS)
    later = np.linspace(min(FIRST_TASK, TRANSITIONS), TRANSITIONS, TASKS).astype(np.int64)
    with open_memory(path) as memory:
        for task, part in enumerate(np.split(met, later[:-1])):
            memory.contribute(
                f"robot {robot}",
                _records(part, generator),
                process=f"process {robot}",
                seq=task,
                task={"index": task},
            )
    return path


def _records(met: np.ndarray, generator: np.random.Generator) -> list[Record]:
    slots = np.sort(generator.permutation(PRIOR_SLOTS + 15)[:PRIOR_SLOTS])
    weights = generator.integers(1 << 24, size=PRIOR_SLOTS)
    found = generator.integers(1 << 24, size=len(met))
    return [
        Record("action_prior", "building", 1, "add", slots, weights),
        Record("transitions", "building", 1, "newest", np.sort(met), found),
    ]


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


def _rows(times: Rates) -> list[dict[str, Any]]:
    size = f"{ROBOTS} memories of {TASKS} tasks"
    singly = paired_ratio(times[SINGLY], times[MANY])
    rebuilt = paired_ratio(times["rebuild"], times[MANY])
    return [
        row(f"{size}, {MANY}", float(np.median(times[MANY])), "s"),
        row(f"{size}, {SINGLY}", float(np.median(times[SINGLY])), "s", f"{size}, {MANY}", singly),
        row(f"{size}, rebuild alone", float(np.median(times["rebuild"])), "s", f"{size}, {MANY}", rebuilt),
    ]


def _goals(times: Rates) -> list[dict[str, Any]]:
    return [at_most(f"seconds, {MANY}", MOST_SECONDS, float(np.median(times[MANY])))]
