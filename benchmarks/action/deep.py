"""`bench deep`: a learnt prior in Stable-Baselines3: what exploring finds, how fast DQN learns, what a step costs.

The prior comes from crossings of two and three walls, by which of left, front and right are open (8 contexts).
Compared is with uniform exploration over the three moves; MiniGrid's other four actions are withheld from both.
Each run of learning is a layout and a network of its own, the same for both. With ten runs or more the figure is
written, ``benchmarks/results/deep.png``. Finished runs are kept, so that a stopped benchmark goes on.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from benchmarks.action import deep_learning, deep_speed, deep_worlds
from benchmarks.action.deep_worlds import (
    GUIDED,
    SEVEN,
    UNIFORM,
    crossing_prior,
    excluded_best,
    exploring,
)
from benchmarks.rounds import at_least, at_most, paired_ratio, row
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.learning.learning_metrics import LearningGain, learning_gain
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.protocols import Progress
from reproduction.engine.cell_store import CellStore
from reproduction.engine.source_key import source_key

EXPLORED = ("SimpleCrossingS9N1", "SimpleCrossingS11N5", "FourRooms")
LEARNT = ("SimpleCrossingS9N1", "SimpleCrossingS11N5")
EPISODES = 200
MOST_OVERHEAD, LEAST_RUNS = 1.05, 10
THRESHOLD = 0.8
PLAIN, PRIOR = "DQN", "DQN with prior"
OUT = Path("benchmarks/results")


def bench_deep(repeats: int, progress: Progress, out: Path = OUT) -> dict:
    """Rows and goals; see `benchmarks.bench`. `repeats` are runs of learning.

    Beside them ``exploring`` and ``learning``, what stands behind the figure, with 95 % intervals.

    Raises
    ------
    MissingExtraError
        Stable-Baselines3 is not installed.
    """
    import lifelore.bridges.sb3  # noqa: F401  says at once which extra is missing

    cases = (deep_speed.SELDOM, deep_speed.ALWAYS, deep_speed.MASKS)
    total = len(EXPLORED) + len(cases) * 2 * deep_speed.ROUNDS + len(LEARNT) * 2 * repeats
    done = 0

    def after(label: str) -> None:
        nonlocal done
        done += 1
        progress(done, total, label)

    prior = crossing_prior()
    explored = {name: _explored(name, prior, after, out) for name in EXPLORED}
    speed_rows, speed_goals = _speed(cases, after)
    learning = {name: _learning(name, prior, repeats, after, out) for name in LEARNT}
    gains = {name: _gain(one["scores"]) for name, one in learning.items()}
    rows = [*_exploring_rows(explored, prior), *speed_rows]
    for name in LEARNT:
        rows += _learning_rows(name, learning[name], gains[name])
    result = {
        "rows": rows,
        "goals": [*speed_goals, *_learning_goals(gains, repeats)],
        "exploring": explored,
        "learning": {name: _told(learning[name], gains[name]) for name in LEARNT},
    }
    if repeats >= LEAST_RUNS:
        _draw(result, out / "bench_deep.png")
    return result


def _store(out: Path, module: str, **settings: Any) -> CellStore:
    """Finished pieces that rest on a module and on settings."""
    return CellStore(out / "deep" / "cells", {"bench": "deep", "code": source_key(module), **settings})


def _kept(store: CellStore, cell: Mapping[str, Any], run: Callable[[], Mapping]) -> Mapping:
    """A finished piece, or the piece run now."""
    kept = store.get(cell)
    if kept is None:
        began = time.perf_counter()
        kept = store.put(cell, run(), time.perf_counter() - began)
    return kept["result"]


# ---- exploring -------------------------------------------------------------------------------------------


def _explored(name: str, prior: ActionPrior, after: Callable[[str], None], out: Path) -> dict[str, dict]:
    store = _store(out, deep_worlds.__name__)
    steps = _kept(store, {"world": name, "episodes": EPISODES}, lambda: exploring(name, prior, EPISODES))
    after(f"exploring {name}")
    return {who: mean_estimate(np.asarray(steps[who]) > 0).to_dict() for who in (SEVEN, UNIFORM, GUIDED)}


def _exploring_rows(explored: Mapping[str, Mapping[str, Mapping]], prior: ActionPrior) -> list[dict]:
    rows = []
    for name, shares in explored.items():
        base = f"{name}, exploring: {UNIFORM}"
        for who, share in shares.items():
            ratio = share["value"] / shares[UNIFORM]["value"] if shares[UNIFORM]["value"] else None
            to = (base, ratio) if who != UNIFORM else (None, None)
            rows.append(row(f"{name}, exploring: {who}", share["value"], "goals an episode", *to))
        rows.append(row(f"{name}, best moves a mask excludes", excluded_best(name, prior, EPISODES), "share"))
    return rows


# ---- speed -----------------------------------------------------------------------------------------------


def _speed(cases: Sequence[str], after: Callable[[str], None]) -> tuple[list[dict], list[dict]]:
    rows, goals = [], []
    for case in cases:
        times = deep_speed.measured(case, lambda who, case=case: after(f"{case}, {who}"), deep_speed.ROUNDS)
        plain, guided = times[deep_speed.PLAIN], times[deep_speed.PRIOR]
        ratio = paired_ratio(guided, plain)
        base = f"a step of {case}, {deep_speed.PLAIN}"
        rows.append(row(base, median(plain), "µs"))
        rows.append(row(f"a step of {case}, {deep_speed.PRIOR}", median(guided), "µs", base, ratio))
        goals.append(at_most(f"a step of {case}: {deep_speed.PRIOR} / {deep_speed.PLAIN}", MOST_OVERHEAD, ratio))
    return rows, goals


# ---- learning --------------------------------------------------------------------------------------------


def _learning(
    name: str, prior: ActionPrior, runs: int, after: Callable[[str], None], out: Path
) -> dict[str, dict[str, list]]:
    """``{"scores": {who: [curve a run]}, "goals": {who: [number a run]}}``."""
    settings = {"settings": deep_learning.SETTINGS, "steps": deep_learning.STEPS, "every": deep_learning.EVERY}
    store = _store(out, deep_learning.__name__, **settings)
    found: dict[str, dict[str, list]] = {"scores": {PLAIN: [], PRIOR: []}, "goals": {PLAIN: [], PRIOR: []}}
    for run in range(runs):
        for who in (PLAIN, PRIOR):
            own = prior if who == PRIOR else None
            told = _kept(
                store,
                {"world": name, "run": run, "who": who},
                partial(deep_learning.learnt, name, run, own, deep_learning.STEPS, deep_learning.EVERY),
            )
            for key in found:
                found[key][who].append(told[key])
            after(f"{name}, {who}, run {run + 1}")
    return found


def _gain(scores: Mapping[str, Sequence[Sequence[float]]]) -> LearningGain:
    return learning_gain(scores[PRIOR], scores[PLAIN], THRESHOLD)


def _learning_rows(name: str, learning: Mapping, gain: LearningGain) -> list[dict]:
    scores, goals = learning["scores"], learning["goals"]
    base = f"{name}, mean score while learning: {PLAIN}"
    means = {who: float(np.mean(scores[who])) for who in (PLAIN, PRIOR)}
    found = {who: float(np.mean(goals[who])) for who in (PLAIN, PRIOR)}
    goal_base = f"{name}, goals reached while learning: {PLAIN}"
    return [
        row(base, means[PLAIN], "of optimal"),
        row(base.replace(PLAIN, PRIOR), means[PRIOR], "of optimal", base, _ratio(means)),
        row(goal_base, found[PLAIN], "goals"),
        row(goal_base.replace(PLAIN, PRIOR), found[PRIOR], "goals", goal_base, _ratio(found)),
        row(f"{name}, steps to {THRESHOLD} of optimal: prior / none", gain.threshold_ratio.value, "ratio"),
        row(f"{name}, runs that never get there: {PLAIN}", gain.baseline_never, "runs"),
        row(f"{name}, runs that never get there: {PRIOR}", gain.never, "runs"),
    ]


def _ratio(of: Mapping[str, float]) -> float | None:
    return of[PRIOR] / of[PLAIN] if of[PLAIN] else None


def _learning_goals(gains: Mapping[str, LearningGain], runs: int) -> list[dict]:
    """The interval decides: better is where even its unfavourable end is."""
    goals = [at_least("runs of learning", LEAST_RUNS, runs)]
    for name, gain in gains.items():
        saved = gain.total_reward.ci95
        goals.append(
            at_most(
                f"{name}, steps to {THRESHOLD} of optimal, upper end of 95 %", 1.0, _end(gain.threshold_ratio, 1)
            )
        )
        goals.append(
            at_least(
                f"{name}, score gained while learning, lower end of 95 %",
                0.0,
                None if saved is None else saved[0] / (deep_learning.STEPS // deep_learning.EVERY),
            )
        )
    return goals


def _end(estimate: Estimate, which: int) -> float | None:
    return None if estimate.ci95 is None else estimate.ci95[which]


def _told(learning: Mapping, gain: LearningGain) -> dict:
    """Curves with 95 % intervals, and the gain."""
    every = deep_learning.EVERY
    curves = {}
    for who in (PLAIN, PRIOR):
        scores = np.asarray(learning["scores"][who])
        points = [mean_estimate(column) for column in scores.T]
        curves[who] = {
            "steps": [every * (k + 1) for k in range(scores.shape[1])],
            "mean": [point.value for point in points],
            "ci95": [list(point.ci95) if point.ci95 else [point.value] * 2 for point in points],
        }
    return {"curves": curves, "goals": learning["goals"], "gain": gain.to_dict()}


def _draw(result: Mapping, path: Path) -> None:
    from benchmarks.action.figure_deep_curves import draw_deep_curves
    from lifelore.figures.style import save_figure

    names = {PLAIN: "scratch", PRIOR: "prior", UNIFORM: "scratch", GUIDED: "prior"}
    save_figure(draw_deep_curves(result["exploring"], result["learning"], names), path)
