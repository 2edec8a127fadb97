"""`bench long_lived_worlds`: the long-lived agent, its ablations and other methods in the factory and buildings.

Each round is one life of each agent in each world, on the same tasks. A row is the return that the first episodes
of a half of the life miss, on the average, of the best possible. Relative returns would mean nothing in the
factory, where the best possible may be about 0. With the figure ``benchmarks/results/long_lived_worlds.png``.
"""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.agent.world_lives import (
    AGENT_NAMES,
    SCRATCH,
    Case,
    Life,
    best_returns,
    cases,
    live,
)
from benchmarks.rounds import at_least, estimated_row
from lifelore.core.metrics import difference_estimate, mean_estimate, ratio_estimate
from lifelore.core.protocols import Progress

Array = NDArray[np.float64]

OUT = Path("benchmarks/results")
FULL = "full"
UNIT = "points below the best possible"
BLOCKS = 4
"""Parts of a life in the figure."""


def bench_long_lived_worlds(repeats: int, progress: Progress, map: str | None = None, out: Path = OUT) -> dict:
    """Rows and goals; see `benchmarks.bench`. `map`: a ROS map of one more building."""
    every = cases(map)
    work = [(case, life) for case in every for life in range(repeats)]
    found: dict[str, dict[str, list[Life]]] = {case.name: {name: [] for name in case.agents} for case in every}
    best: dict[str, list[Array]] = {case.name: [] for case in every}
    for done, (case, life) in enumerate(work):
        family = case.family(life)
        best[case.name].append(best_returns(family, case.n_tasks))
        for name in case.agents:
            found[case.name][name].append(live(name, family, best[case.name][-1], case.n_episodes))
        progress(done + 1, len(work), f"{case.name}, life {life}")
    rows, goals = [], []
    for case in every:
        lives = found[case.name]
        if "changes" in case.name:
            rows += _rows_of_changes(case, lives)
        else:
            rows += _rows_of_halves(case, lives, best[case.name])
            goals += _goals(case, lives)
    _draw(every, found, out)
    return {"rows": rows, "goals": goals}


def _missed(lives: Sequence[Life], first: int, last: int) -> Array:
    """(n_lives,) mean of the first episodes of some tasks."""
    return np.array([life.missed[first:last, 0].mean() for life in lives])


def _halves(case: Case) -> dict[str, tuple[int, int]]:
    half = case.n_tasks // 2
    return {"first half": (0, half), "second half": (half, case.n_tasks)}


def _rows_of_halves(case: Case, lives: dict[str, list[Life]], best: Sequence[Array]) -> list[dict]:
    rows = []
    for half, tasks in _halves(case).items():
        scratch = _missed(lives[SCRATCH], *tasks)
        possible = np.array([returns[slice(*tasks)].mean() for returns in best])
        rows.append(estimated_row(f"{case.name}, {half}: best possible return", mean_estimate(possible), "points"))
        for name, own in lives.items():
            missed = _missed(own, *tasks)
            label = f"{case.name}, {half}: {name}"
            ratio = None if name == SCRATCH else ratio_estimate(missed, scratch)
            reference = f"{case.name}, {half}: {SCRATCH}"
            rows.append(estimated_row(label, mean_estimate(missed), UNIT, reference, ratio))
            if name != FULL:
                more = difference_estimate(missed, _missed(lives[FULL], *tasks))
                rows.append(estimated_row(f"{label}, more than {FULL}", more, "points"))
    return rows


def _rows_of_changes(case: Case, lives: dict[str, list[Life]]) -> list[dict]:
    """Before the late type, from its arrival until the usual types change, and then; who noticed the late type."""
    arrival, change = case.n_tasks // 2, case.n_tasks * 3 // 4
    spans = {
        "before the late type": (arrival // 2, arrival),
        "after its arrival": (arrival, change),
        "after the change": (change, case.n_tasks),
    }
    rows = []
    for span, tasks in spans.items():
        for name, own in lives.items():
            rows.append(estimated_row(f"{case.name}, {span}: {name}", mean_estimate(_missed(own, *tasks)), UNIT))
            if name != FULL:
                more = difference_estimate(_missed(own, *tasks), _missed(lives[FULL], *tasks))
                rows.append(estimated_row(f"{case.name}, {span}: {name}, more than {FULL}", more, "points"))
    noticed = mean_estimate([float(life.alarms[arrival]) for life in lives[FULL]])
    false = mean_estimate([float(life.alarms[arrival // 2 : arrival].mean()) for life in lives[FULL]])
    return [
        *rows,
        estimated_row(f"{case.name}: alarm at the first task of the late type", noticed, "share"),
        estimated_row(f"{case.name}: alarms in the quarter before", false, "share"),
    ]


def _goals(case: Case, lives: dict[str, list[Life]]) -> list[dict]:
    """Every part of the agent pays in the second half: lower ends of the paired intervals."""
    tasks, goals = _halves(case)["second half"], []
    for name in AGENT_NAMES[1:]:
        more = difference_estimate(_missed(lives[name], *tasks), _missed(lives[FULL], *tasks))
        low = None if more.ci95 is None else more.ci95[0]
        goals.append(at_least(f"{case.name}: {name} more than {FULL}, lower end of the interval", 0.0, low))
    return goals


def _draw(every: Sequence[Case], found: dict[str, dict[str, list[Life]]], out: Path) -> None:
    from benchmarks.agent.figure_world_lives import draw_world_lives
    from lifelore.figures.style import save_figure

    panels = {}
    for case in every:
        edges = np.linspace(0, case.n_tasks, BLOCKS + 1).astype(int)
        series = {
            name: [float(_missed(lives, a, b).mean()) for a, b in pairwise(edges)]
            for name, lives in found[case.name].items()
        }
        panels[case.name] = ([float(middle) for middle in (edges[:-1] + edges[1:]) / 2], series)
    out.mkdir(parents=True, exist_ok=True)
    save_figure(draw_world_lives(panels), out / "bench_long_lived_worlds.png")
