"""`bench factory`: enumerating and solving a task of four components, and the room that learning nine takes.

Solving goes by the order of configurations; beside it, sweeps over all states at once (value iteration) and the
same tables filled in plain Python, as a textbook does.
"""

import subprocess
import sys
import time
from collections.abc import Callable
from statistics import median

import numpy as np

from benchmarks.rounds import at_most, interleaved, paired_ratio, row
from lifelore.core.errors import LifeloreError
from lifelore.core.mdp import Tables, _enumerate_with
from lifelore.core.planning.planning import optimal_q
from lifelore.core.protocols import Progress
from lifelore.domains.factory.factory import FactoryTask
from lifelore.domains.factory.layout import factory

COMPONENTS, ALL = 4, 9
TABLES_MS, SOLVE_MS, ROOM_MB = 20.0, 50.0, 300.0
"""Goals."""
TABLES, SOLVE = "tables of four components, compiled", "exact solution, by configurations"
PLAIN, SWEEPS = "tables of four components, plain Python", "exact solution, sweeps over all states"
ROOM = "learning nine components, above the imports"
_NINE = """
import resource, sys
from pathlib import Path
from benchmarks.action.factory import learn_all

def held(now):
    # Linux hands a parent's peak down to its children, but keeps a process's own beside it.
    status = Path("/proc/self/status")
    if status.exists():
        lines = dict(line.split(":", 1) for line in status.read_text().splitlines())
        return 1024 * int(lines["VmRSS" if now else "VmHWM"].split()[0])
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)

learn_all(1, 5)
before = held(now=True)
learn_all({components}, {episodes})
print(held(now=False) - before)
"""


def bench_factory(repeats: int, progress: Progress, episodes: int = 400) -> dict:
    """Rows and goals; see `benchmarks.bench`. `episodes`: of learning nine components."""
    task = factory().task(range(COMPONENTS))
    tables = task.tables()
    _check_equal(task, tables)
    contenders = {
        TABLES: lambda: _milliseconds(task.tables),
        SOLVE: lambda: _milliseconds(lambda: task.optimal_q(tables)),
        PLAIN: lambda: _milliseconds(lambda: _enumerate_with(task.domain)(task.params, [0.5])),
        SWEEPS: lambda: _milliseconds(lambda: optimal_q(tables, task.domain.discount)),
    }
    total, done = repeats * len(contenders) + 1, 0

    def after(name: str) -> None:
        nonlocal done
        done += 1
        progress(done, total, name)

    times = interleaved(contenders, repeats, after)
    room = megabytes_of_all(episodes)
    progress(total, total, ROOM)
    rows = [row(name, median(times[name]), "ms") for name in (TABLES, SOLVE)]
    for name, ours in ((PLAIN, TABLES), (SWEEPS, SOLVE)):
        rows.append(row(name, median(times[name]), "ms", ours, paired_ratio(times[name], times[ours])))
    rows.append(row(ROOM, room, "MB"))
    goals = [
        at_most(f"{TABLES}, ms", TABLES_MS, rows[0]["value"]),
        at_most(f"{SOLVE}, ms", SOLVE_MS, rows[1]["value"]),
        at_most(f"{ROOM}, MB", ROOM_MB, room),
    ]
    return {"rows": rows, "goals": goals}


def learn_all(components: int, episodes: int) -> None:
    """Learn a task of the first components with the configurations that are met."""
    from lifelore.core.learning.layered_learning import LayeredLearning
    from lifelore.core.learning.q_learner import QLearning
    from lifelore.core.streams import stream

    task = factory().task(range(components))
    world, own = (stream(0, "bench factory", name) for name in ("world", "own"))
    part = LayeredLearning(
        task.configuration_tables, task.n_configurations, task.factory.n_cells, world=world, own=own
    )
    part.learn(QLearning(episodes=episodes, max_steps=5000, epsilon_decay=0.95), task.domain.discount)


def megabytes_of_all(episodes: int, components: int = ALL) -> float:
    """Peak memory of a fresh process that learns, less what it held with everything imported and compiled, MB."""
    source = _NINE.format(components=components, episodes=episodes)
    done = subprocess.run([sys.executable, "-c", source], capture_output=True, text=True, check=False)
    if done.returncode:
        raise LifeloreError(f"a measured process must end well, got '{done.stderr.strip().splitlines()[-1]}'")
    return float(done.stdout) / 1e6


def _milliseconds(work: Callable[[], object]) -> float:
    started = time.perf_counter()
    work()
    return 1e3 * (time.perf_counter() - started)


def _check_equal(task: FactoryTask, tables: Tables) -> None:
    """Both ways to the exact values agree, and kernels are warm from here on."""
    near = np.allclose(task.optimal_q(tables), optimal_q(tables, task.domain.discount), atol=1e-6)
    if not near:
        raise LifeloreError("both ways must find the same values, got others by configurations than by sweeps")
