"""`bench large_memory`: what a memory of up to ten million contexts costs on disk, in main memory and in time.

A prior has counted `COUNTED` of `ACTIONS` actions in each context; types take the place of actions in a prior over
types. New processes open the memory, read single contexts, contribute tasks with contexts anywhere in it, and load
the whole prior. Seconds are the processor's, with the file in the system's cache. With three repeats or more the
figure is written, ``benchmarks/results/large_memory.png``.
"""

import tempfile
from collections.abc import Mapping
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING

from benchmarks.fleet.large_memory_case import COUNTED, TASK_CONTEXTS, fill, probed
from benchmarks.rounds import at_most, row
from lifelore.core.protocols import Progress

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CONTEXTS = (1_000, 10_000, 100_000, 1_000_000, 10_000_000)
SLOPE_CONTEXTS, SLOPE_COUNTED = 100_000, (1, 2, 4)
"""Size of the memories whose growth with the counted actions of a context is measured."""
MOST_READ, MOST_OPEN = 1e6, 0.05
"""Goals at the largest size: bytes read and seconds needed to open it."""
LEAST_REPEATS = 3
OUT = Path("benchmarks/results")
Measured = dict[int, dict[str, float]]
"""What was measured, by number of contexts and name; see `large_memory_case.probe`."""


def bench_large_memory(repeats: int, progress: Progress, out: Path = OUT) -> dict:
    """Rows and goals; see `benchmarks.bench`. Beside them ``contexts``: all measures by number."""
    total, done = len(CONTEXTS) * (1 + repeats) + len(SLOPE_COUNTED), 0

    def after(label: str) -> None:
        nonlocal done
        done += 1
        progress(done, total, label)

    measured: Measured = {}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "large.db"
        pairs = {}
        for counted in SLOPE_COUNTED:
            pairs[counted] = _filled(path, SLOPE_CONTEXTS, counted) / SLOPE_CONTEXTS
            after(f"{SLOPE_CONTEXTS:,} contexts, {counted} actions")
        for n in CONTEXTS:
            size = _filled(path, n, COUNTED)
            after(f"{n:,} contexts filled")
            rounds = []
            for number in range(repeats):
                rounds.append(probed(path, n, whole=number == 0))
                after(f"{n:,} contexts")
            measured[n] = {"file_bytes": float(size)} | _medians(rounds)
    result = {
        "rows": [*_rows(measured), *_pair_rows(pairs)],
        "goals": _goals(measured),
        "contexts": {str(n): found for n, found in measured.items()},
    }
    if repeats >= LEAST_REPEATS:
        from lifelore.figures.style import save_figure

        save_figure(_figure(measured), out / "bench_large_memory.png")
    return result


def _filled(path: Path, contexts: int, counted: int) -> int:
    """Bytes of a new memory at `path`, which is closed."""
    path.unlink(missing_ok=True)
    fill(path, contexts, counted)
    return path.stat().st_size


def _medians(rounds: list[dict[str, float]]) -> dict[str, float]:
    """Medians over processes; what only the first has measured stays as it is."""
    return {name: median(found[name] for found in rounds if name in found) for name in rounds[0]}


def _rows(measured: Measured) -> list[dict]:
    rows = []
    for n, found in measured.items():
        of = f"{n:,} contexts"
        rows += [
            row(f"{of}: file", found["file_bytes"] / 1e6, "MB"),
            row(f"{of}: open", 1e3 * found["open"], "ms"),
            row(f"{of}: read to open", found["read_bytes"] / 1e6, "MB"),
            row(f"{of}: main memory of a process that reads and writes some", found["open_bytes"] / 1e6, "MB"),
            row(f"{of}: recall one context", 1e6 * found["recall"], "µs"),
            row(f"{of}: take a task", 1e3 * found["take"], "ms"),
            row(f"{of}: contribute a task of {TASK_CONTEXTS} contexts", 1e3 * found["contribute"], "ms"),
            row(f"{of}: load all", found["load"], "s"),
            row(f"{of}: most main memory to load all", found["load_bytes"] / 1e6, "MB"),
        ]
    *_, less, more = sorted(measured)
    for name, label in (("file_bytes", "file"), ("load_bytes", "main memory to load all")):
        slope = (measured[more][name] - measured[less][name]) / (more - less)
        rows.append(row(f"a context more ({COUNTED} actions counted): {label}", slope, "B"))
    return rows


def _pair_rows(sizes: Mapping[int, float]) -> list[dict]:
    """Growth of the file with each further counted action, or type, of a context."""
    counts = sorted(sizes)
    return [
        row(f"file of a context with {counts[0]} action counted", sizes[counts[0]], "B"),
        row(
            "file of a (context, action) or (context, type) more",
            (sizes[counts[-1]] - sizes[counts[0]]) / (counts[-1] - counts[0]),
            "B",
        ),
    ]


def _goals(measured: Measured) -> list[dict]:
    most, found = f"{max(measured):,} contexts", measured[max(measured)]
    return [
        at_most(f"MB read to open a memory of {most}", MOST_READ / 1e6, found["read_bytes"] / 1e6),
        at_most(f"seconds to open a memory of {most}", MOST_OPEN, found["open"]),
    ]


def _figure(measured: Measured) -> "Figure":
    from benchmarks.fleet.figure_large_memory import draw_large_memory

    def column(name: str) -> dict[int, float]:
        return {n: found[name] for n, found in measured.items()}

    sizes = {
        "file": column("file_bytes"),
        "most main memory to load all": column("load_bytes"),
        "main memory to read and write some": column("open_bytes"),
        "read to open": column("read_bytes"),
    }
    seconds = {
        "load all": column("load"),
        "open": column("open"),
        f"contribute a task of {TASK_CONTEXTS} contexts": column("contribute"),
        "recall one context": column("recall"),
    }
    return draw_large_memory(sizes, seconds)
