"""C3.16: Q-learning with advice in its ε branch finds its goal within a handful of episodes; without, it does not.

ε and its annealing, and where a task's episodes start, are not printed: they are crossed with the maze's loops and
the kinds of experts. Tasks of one maze are not independent: intervals are over mazes. Thesis: §3.7.2, Figure 3.22.
"""

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter3.advice_estimates import (
    at,
    check_grid,
    grid_of,
    maze_estimate,
    picked,
    plain,
    share_of_grid,
)
from lifelore.experiments.chapter3.advice_grid import GRID, SMALL, maze_cells
from lifelore.experiments.chapter3.advised_learning import LEARNING, STARTS, run_cell
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.curve_blocks import block_edges
from lifelore.experiments.engine.predicate import Predicate

FULL = {
    **GRID,
    **LEARNING,
    "mazes": 16,
    "starts": list(STARTS),
    "schedules": [[1.0, 0.999, 0.05], [0.1, 1.0, 0.1]],
    "default": {**GRID["default"], "starts": "one", "schedule": [1.0, 0.999, 0.05]},
}
QUICK = {
    **FULL,
    **SMALL,
    "mazes": 3,
    "tasks": 3,
    "episodes": 100,
    "max_episode_steps": 40,
    "last": 20,
    "default": FULL["default"],
}
CAUSES = {
    "a handful with advice": "one prior over eight goals leads from a start to some of them, seldom to the rest",
    "not without": "a goal near the start, or episodes that start anywhere, are found by chance",
    "most of the grid": "where episodes start anywhere, chance puts some beside the goal and no advice is needed; "
    "where ε is small, advice is seldom followed; policies known in every state lead to the middle of the maze",
}


def _check(settings: Mapping) -> None:
    check_grid(settings, ("tasks", "episodes", "max_episode_steps", "last"))
    if settings["last"] > settings["episodes"]:
        raise InputError(f"last must be at most episodes ({settings['episodes']}), got {settings['last']}")
    if not 0 <= settings["learning_rate"] <= 1:
        raise InputError(f"learning_rate must lie in [0, 1], got {settings['learning_rate']}")
    if not settings["starts"] or not set(settings["starts"]) <= set(STARTS):
        raise InputError(f"starts must be among {', '.join(STARTS)}, got {settings['starts']}")
    for schedule in settings["schedules"]:
        if np.shape(schedule) != (3,) or not all(0 <= x <= 1 for x in schedule):
            raise InputError(
                f"schedules must each be three numbers in [0, 1], first ε, factor and floor, got {schedule}"
            )
    default = settings["default"]
    if default.get("starts") not in settings["starts"] or default.get("schedule") not in settings["schedules"]:
        raise InputError(f"default must be a cell of the grid of starts and schedules, got {default}")


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """At the default: goals found within ten episodes and ever, when, and the reward at the end; the grid."""
    default = settings["default"]
    how = {"starts": default["starts"], "schedule": default["schedule"]}
    cells = at(results, default["loops"])
    columns = {"plain": None, "advised": default["experts"]}
    found = {}
    for key, name in (("in_ten", "found_in_ten"), ("ever", "found_ever"), ("final", "final")):
        alone, told = (_means(cells, how, experts, key) for experts in columns.values())
        found |= {f"{name}_plain": maze_estimate(alone), f"{name}_advised": maze_estimate(told)}
        found[f"{name}_gain"] = maze_estimate(told - alone)
    for name, experts in columns.items():
        firsts = [t["first"] for t in _tasks(cells, how, experts)]
        found[f"first_{name}"] = maze_estimate(_means(cells, how, experts, "first"))
        found[f"median_first_{name}"] = plain(np.median(firsts), len(firsts))
    grid = _grid(settings)
    answers = [_is_handful(at(results, loops), how, experts) for loops, experts, how in grid]
    found["grid_handful"] = share_of_grid(answers)
    return found


def _grid(settings: Mapping) -> list[tuple[float, str, dict]]:
    hows = [{"starts": s, "schedule": e} for s, e in product(settings["starts"], settings["schedules"])]
    return [(loops, experts, how) for how in hows for loops, experts in grid_of(settings)]


def _tasks(cells: Sequence[Mapping], how: Mapping, experts: str | None) -> list[Mapping]:
    return [task for cell in cells for task in picked(cell["learners"], **how, experts=experts)["tasks"]]


def _means(cells: Sequence[Mapping], how: Mapping, experts: str | None, key: str) -> np.ndarray:
    """Each maze's mean over its tasks."""
    return np.array([np.mean([t[key] for t in _tasks([cell], how, experts)]) for cell in cells])


def _is_handful(cells: Sequence[Mapping], how: Mapping, experts: str) -> bool:
    """Whether most tasks' goals are found within ten episodes with advice, and at most 1 of 20 without."""
    told, alone = (_means(cells, how, e, "in_ten").mean() for e in (experts, None))
    return bool(told > 0.5 and alone <= 0.05)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The grid, a row a cell; then the default's curves by starts, with one standard deviation."""
    found = []
    for loops, experts, how in _grid(settings):
        cells = at(results, loops)
        row = {"loops": loops, "experts": experts, **how}
        for name, of in (("plain", None), ("advised", experts)):
            row[name] = {key: round(float(_means(cells, how, of, key).mean()), 3) for key in ("in_ten", "ever")}
            row[name]["final"] = round(float(_means(cells, how, of, "final").mean()), 1)
            row[name]["median_first"] = float(np.median([t["first"] for t in _tasks(cells, how, of)]))
        found.append(row)
    return found + _curves(settings, results)


def _curves(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    default = settings["default"]
    cells = at(results, default["loops"])
    found: list[dict] = [{"curve_edges": block_edges(settings["episodes"]).tolist()}]
    for starts in settings["starts"]:
        for name, experts in (("plain", None), ("advised", default["experts"])):
            how = {"starts": starts, "schedule": default["schedule"], "experts": experts}
            curves = np.array([picked(cell["learners"], **how)["curve"] for cell in cells])
            spread = curves.std(axis=0, ddof=1) if len(curves) > 1 else np.zeros(curves.shape[1])
            mean, spread = (np.round(of, 1).tolist() for of in (curves.mean(axis=0), spread))
            found.append({"curve_of": name, "starts": starts, "mean": mean, "deviation": spread})
    return found


def _draw(result: Mapping):
    from lifelore.experiments.chapter3.c3_16_advised_learning.figure_advised_learning import draw_advised_learning

    return draw_advised_learning(result)


CLAIM = Claim(
    id="C3.16",
    title="Q-learning with advice (Figure 3.22)",
    thesis="Using advice, the learning agent can discover the correct goal location within a handful of episodes, "
    "something which is not possible otherwise (20 tasks, κ = 0.5, 5,000 episodes of at most 200 steps).",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C3.16"),
    cells=maze_cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes=CAUSES,
    check=_check,
)
