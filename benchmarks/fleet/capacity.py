"""`bench capacity`: the cost of a million Q-learners and ten million contexts here, and what a GPU would change.

Bytes and rates are measured over growing numbers of Q-learners of the 23×23 lattice, of contexts of a prior and of
a memory's contributions. Rates are of one core, by its own seconds of work, so that other programs count little.
A row that says *extrapolated* is the row named by its `ratio_to`, the slope between the two largest numbers
measured, times its `ratio`. A row that says *a GPU at most* is arithmetic from measured rates and from
``assumptions``: nothing was measured on a GPU. With five repeats or more the figure is written,
``benchmarks/results/capacity.png``.
"""

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from statistics import median

from benchmarks.fleet.capacity_case import (
    TURN,
    Contexts,
    Learners,
    bytes_of,
    contributions,
    move_rate,
)
from benchmarks.fleet.gpu_bound import Gpu
from benchmarks.rounds import row
from lifelore.core.protocols import Progress
from lifelore.core.usable_cores import usable_cores

LEARNERS = (1, 10, 100, 1_000, 10_000)
CONTEXTS = (1_000, 10_000, 100_000, 1_000_000, 10_000_000)
CONTRIBUTIONS = (10, 100, 1_000)
MANY_LEARNERS, MANY_CONTEXTS, MANY_CONTRIBUTIONS = 1_000_000, 10_000_000, 1_000_000
"""Numbers that are planned for: measured if they are among those above, else extrapolated."""
LEAST_REPEATS = 5
OUT = Path("benchmarks/results")
Measured = dict[int, dict[str, float]]
"""What was measured, by number and name."""


def bench_capacity(repeats: int, progress: Progress, out: Path = OUT) -> dict:
    """Rows; see `benchmarks.bench`. There are no goals.

    Beside them ``learners``, ``contexts`` and ``contributions``: bytes and rates by number; ``moves``: moves of
    `step` a second; ``machine``: its cores and bytes; ``assumptions``: those about a GPU.
    """
    total, done = len(LEARNERS) + len(CONTEXTS) + 2, 0

    def after(label: str) -> None:
        nonlocal done
        done += 1
        progress(done, total, label)

    machine = {
        "cores": usable_cores(),
        "bytes": os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"),
    }
    learners = {n: _learners(n, repeats, after) for n in LEARNERS}
    contexts = {n: _contexts(n, repeats, after) for n in CONTEXTS}
    stored = contributions(CONTRIBUTIONS)
    after("contributions")
    moves = median(move_rate() for _ in range(repeats))
    after("moves of step")
    rows = [*_learner_rows(learners), *_context_rows(contexts), *_contribution_rows(stored)]
    rows += _gpu_rows(learners, contexts, moves, machine["cores"], Gpu())
    rows.append(row("memory of this machine", machine["bytes"] / 1e9, "GB"))
    result = {
        "rows": rows,
        "goals": [],
        "learners": _plain(learners),
        "contexts": _plain(contexts),
        "contributions": _plain(stored),
        "moves": moves,
        "machine": machine,
        "assumptions": Gpu().to_dict(),
    }
    if repeats >= LEAST_REPEATS:
        _draw(learners, contexts, stored, machine, out / "bench_capacity.png")
    return result


def _plain(measured: Measured) -> dict[str, dict[str, float]]:
    return {str(n): dict(values) for n, values in measured.items()}


# ---- measuring -------------------------------------------------------------------------------------------


def _learners(n: int, repeats: int, after: Callable[[str], None]) -> dict[str, float]:
    Learners(1)  # what all share is made before bytes are counted
    many, size = bytes_of(lambda: Learners(n))
    many.advance()  # compiled, and every page touched, before anything is timed
    rates = [many.rate() for _ in range(repeats)]
    after(f"{n:,} Q-learners")
    return {"bytes": size, "steps": median(rates)}


def _contexts(n: int, repeats: int, after: Callable[[str], None]) -> dict[str, float]:
    prior = Contexts(n)
    rates = [(prior.updates(), prior.samples()) for _ in range(repeats)]
    after(f"{n:,} contexts")
    updates, samples = (median(column) for column in zip(*rates, strict=True))
    return {"bytes": prior.bytes, "updates": updates, "samples": samples}


# ---- rows ------------------------------------------------------------------------------------------------


def _learner_rows(learners: Measured) -> list[dict]:
    rows = []
    for n, found in learners.items():
        rows.append(row(f"Q-learners, {n:,}: memory", found["bytes"] / 1e6, "MB"))
        rows.append(row(f"Q-learners, {n:,}: one core", found["steps"] / 1e6, "Msteps/s"))
    sizes = {n: found["bytes"] for n, found in learners.items()}
    seconds = {n: n * TURN / found["steps"] for n, found in learners.items()}
    rows += _planned("Q-learner", MANY_LEARNERS, "memory", sizes, (1e3, "kB"), (1e9, "GB"))
    rows += _planned(
        "Q-learner", MANY_LEARNERS, f"{TURN:,} steps of each, one core", seconds, (1e-6, "µs"), (1, "s")
    )
    return rows


def _context_rows(contexts: Measured) -> list[dict]:
    rows = []
    for n, found in contexts.items():
        rows.append(row(f"contexts, {n:,}: memory", found["bytes"] / 1e6, "MB"))
        rows.append(row(f"contexts, {n:,}: counted once more", found["updates"] / 1e6, "Mcontexts/s"))
        rows.append(row(f"contexts, {n:,}: an action drawn", found["samples"] / 1e6, "Mcontexts/s"))
    sizes = {n: found["bytes"] for n, found in contexts.items()}
    rows += _planned("context", MANY_CONTEXTS, "memory", sizes, (1, "B"), (1e9, "GB"))
    for what, rate in (("counting all once more", "updates"), ("drawing an action for each", "samples")):
        seconds = {n: n / found[rate] for n, found in contexts.items()}
        rows += _planned("context", MANY_CONTEXTS, what, seconds, (1e-9, "ns"), (1, "s"))
    return rows


def _contribution_rows(stored: Measured) -> list[dict]:
    rows = []
    for n, found in stored.items():
        rows.append(row(f"contributions, {n:,}: file", found["bytes"] / 1e3, "kB"))
        rows.append(row(f"contributions, {n:,}: one more", 1e3 * found["seconds"], "ms"))
    sizes = {n: found["bytes"] for n, found in stored.items()}
    seconds = {n: found["seconds_of_all"] for n, found in stored.items()}
    rows += _planned("contribution", MANY_CONTRIBUTIONS, "file", sizes, (1, "B"), (1e9, "GB"))
    rows += _planned("contribution", MANY_CONTRIBUTIONS, "storing", seconds, (1e-3, "ms"), (3600, "h"))
    return rows


def _planned(
    of: str, number: int, what: str, measured: Mapping[int, float], one: tuple[float, str], all_: tuple[float, str]
) -> list[dict]:
    """The slope between the two largest numbers, and that slope times the number planned for, unless measured."""
    slope = row(f"a {of} more: {what}", slope_of(measured) / one[0], one[1])
    if number in measured:
        return [slope]
    name = f"{of}s, {number:,}: {what} (extrapolated)"
    return [
        slope,
        row(name, slope_of(measured) * number / all_[0], all_[1], slope["name"], number * one[0] / all_[0]),
    ]


def slope_of(measured: Mapping[int, float]) -> float:
    """The increase a piece between the two largest numbers measured."""
    *_, less, more = sorted(measured)
    return (measured[more] - measured[less]) / (more - less)


def _gpu_rows(learners: Measured, contexts: Measured, moves: float, cores: int, gpu: Gpu) -> list[dict]:
    """Bounds beside the largest numbers measured, and beside all cores at the rate of one; None if never ahead."""
    size = slope_of({n: found["bytes"] for n, found in learners.items()})
    step, draw = learners[max(learners)]["steps"], contexts[max(contexts)]["samples"]
    stay, copied = gpu.most_steps(MANY_LEARNERS), gpu.most_steps_with_copies(MANY_LEARNERS, size, TURN)
    stepping, drawing = f"Q-learners, {max(learners):,}: one core", f"contexts, {max(contexts):,}: an action drawn"
    moving, many, all_ = "moves of the scalar step: one core", f"{MANY_LEARNERS:,} Q-learners", f"{cores} cores"
    return [
        row(f"{many} that stay there, a GPU at most", stay / 1e6, "Msteps/s", stepping, stay / step),
        row(
            f"{many} copied for {TURN:,} steps each, a GPU at most", copied / 1e6, "Msteps/s",
            stepping, copied / step,
        ),
        row("Q-learners at which a GPU at most equals one core", gpu.learners_to_beat(step), "Q-learners"),
        row(f"Q-learners at which a GPU at most equals {all_}", gpu.learners_to_beat(cores * step), "Q-learners"),
        row(
            f"steps of each of {many} at which a GPU at most, copying, equals {all_}",
            gpu.steps_to_beat(cores * step, MANY_LEARNERS, size), "steps",
        ),
        row(
            "actions drawn, a GPU at most", gpu.most_samples() / 1e6, "Mcontexts/s",
            drawing, gpu.most_samples() / draw,
        ),
        row("actions of a call at which a GPU at most equals one core", gpu.samples_to_beat(draw), "contexts"),
        row(moving, moves / 1e6, "Mmoves/s"),
        row(
            "moves copied there and back, a GPU at most", gpu.most_moves() / 1e6, "Mmoves/s",
            moving, gpu.most_moves() / moves,
        ),
    ]  # fmt: skip


def _draw(
    learners: Measured, contexts: Measured, stored: Measured, machine: Mapping[str, float], path: Path
) -> None:
    from benchmarks.fleet.figure_capacity_curves import draw_capacity_curves
    from lifelore.figures.style import save_figure

    kinds = {
        "Q-learners": (learners, MANY_LEARNERS),
        "contexts of a prior": (contexts, MANY_CONTEXTS),
        "contributions": (stored, MANY_CONTRIBUTIONS),
    }
    sizes = {name: {n: found["bytes"] for n, found in measured.items()} for name, (measured, _) in kinds.items()}
    planned = {
        name: {number: slope_of(sizes[name]) * number}
        for name, (_, number) in kinds.items()
        if number not in sizes[name]
    }
    rates = {
        "steps of Q-learners": {n: found["steps"] for n, found in learners.items()},
        "contexts counted": {n: found["updates"] for n, found in contexts.items()},
        "actions drawn": {n: found["samples"] for n, found in contexts.items()},
    }
    gpu, size = Gpu(), slope_of(sizes["Q-learners"])
    numbers = [10 ** (k / 8) for k in range(8 * 6 + 1)]
    step, cores = learners[max(learners)]["steps"], machine["cores"]
    bounds = {
        "they stay on it": [gpu.most_steps(n) for n in numbers],
        f"copied for {TURN:,} steps each": [gpu.most_steps_with_copies(n, size, TURN) for n in numbers],
    }
    marks = {"one core, measured": step, f"{cores:.0f} cores at that rate": cores * step}
    note = (
        f"The bounds assume {gpu.bandwidth / 1e12:g} TB/s of a GPU's memory, {gpu.transfer / 1e9:g} GB/s to it, "
        f"{1e9 * gpu.latency:.0f} ns a read and {1e6 * gpu.launch:.0f} µs a launch; nothing was measured on a GPU."
    )
    figure = draw_capacity_curves(sizes, planned, machine["bytes"], rates, numbers, bounds, marks, note)
    save_figure(figure, path)
