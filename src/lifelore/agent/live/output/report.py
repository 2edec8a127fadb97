"""Writes the folder of `lifelore live --out`: the report, pictures, and files for other programs."""

import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.live.baselines import AGENTS
from lifelore.agent.live.goals.destinations import Point
from lifelore.agent.live.life import Life
from lifelore.agent.live.output.drive_figure import drives_figure
from lifelore.agent.live.output.folder import folder_to_write
from lifelore.agent.live.output.greedy_paths import GreedyPaths, last_paths, path_points, write_paths
from lifelore.agent.live.output.known_building import NAV2_FILES, KnownBuilding
from lifelore.agent.live.output.logged_life import goal_points
from lifelore.core.errors import InputError
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.figures.lives.floor_plan import FloorPlan
from lifelore.figures.lives.life_curves import draw_life
from lifelore.figures.lives.map_plan import MapPlan
from lifelore.figures.lives.prior_map import draw_prior_map
from lifelore.figures.lives.world_map import draw_world_map
from lifelore.figures.style import save_figure

FILES = ("summary.json", "life.png", "world.png", "paths.csv", "prior.png", *NAV2_FILES)
"""Files of the folder; the prior only if the agent has one, those of nav2 only in buildings whose moves it has
learnt."""


def check_folder(path: str) -> None:
    """Make the folder and test that it can be written to, before a long run.

    Raises
    ------
    InputError
        `path` is empty, a file or below a file; or a folder has the name of a file to write.
    StoreError
        The folder cannot be written: the disk is full or read-only, or permission is missing.
    """
    with folder_to_write(path) as folder, tempfile.TemporaryFile(dir=folder) as probe:
        probe.write(b"\0")
    for name in FILES:
        if (folder / name).is_dir():
            raise InputError(f"out must have no folder named {name}, but {path} has it; choose another folder")


def write_portfolio(life: Life, out: str) -> list[str]:
    """Write report, pictures and exports of a life into the folder `out`, which is made if it is missing.

    Every file is written completely or not at all. Files of an earlier life are replaced, or removed if this life
    has no such file. A life without a finished task has only its report.

    Parameters
    ----------
    life : Life
    out : str

    Returns
    -------
    list of str
        Paths of the files written, in the order of `FILES`.

    Raises
    ------
    InputError, StoreError
        The folder cannot be written, see `check_folder`.
    """
    check_folder(out)
    with folder_to_write(out) as folder, tempfile.TemporaryDirectory(dir=folder, prefix=".part-") as part:
        _write_all(life, Path(part))
        written = [name for name in FILES if (Path(part) / name).exists()]
        for name in FILES:
            if name in written:
                os.replace(Path(part) / name, folder / name)
            else:
                (folder / name).unlink(missing_ok=True)
    return [str(folder / name) for name in written]


def _write_all(life: Life, folder: Path) -> None:
    text = json.dumps(life.report, indent=2, allow_nan=False)
    (folder / "summary.json").write_text(text + "\n", encoding="utf-8")
    if not life.results:
        return
    paths = last_paths(life)
    lines = {task.task: path_points(life.world, task, life.floor) for task in paths}
    save_figure(drives_figure(life, _place(life)) if life.driven else _life_figure(life), folder / "life.png")
    save_figure(_world_figure(life, paths, lines), folder / "world.png")
    write_paths(folder / "paths.csv", lines)
    if _has_prior(life):
        save_figure(_prior_figure(life), folder / "prior.png")
    if life.building is not None:
        life.building.write(folder, _goals(life, life.building))


def _goals(life: Life, building: KnownBuilding) -> dict[str, Point]:
    """The goals, the last ones first; memory knows those with a name by itself."""
    tasks = [task for task in life.report["tasks"] if not task.get("name")]
    points = goal_points(life, building, tasks)
    return {f"goal {task['index']}": point for task, point in reversed(list(zip(tasks, points, strict=True)))}


def _agents(life: Life) -> list[str]:
    """Names of the agents; memory stores the knowledge of the first."""
    return list(life.results[0])


def _place(life: Life) -> str:
    report = life.report
    if report["map"]:
        return Path(report["map"]).stem
    return f"office {report['seed']}" if report["domain"] == "building" else report["domain"]


def _count(n: int, noun: str) -> str:
    return f"{n:,} {noun}" if n == 1 else f"{n:,} {noun}s"


# ---- pictures --------------------------------------------------------------------------------------


def _life_figure(life: Life):
    tasks = life.report["tasks"]
    agents = {
        name: {
            measure: [task["agents"][name][measure] for task in tasks]
            for measure in ("steps_to_80", "collisions", "reached")
        }
        for name in _agents(life)
    }
    return draw_life([task["index"] for task in tasks], agents, title=_headline(life))


def _headline(life: Life) -> str:
    """The life in one line, with its ratios to scratch if it has any."""
    title = f"{_count(len(life.results), 'task')} in {_place(life)}"
    name = _agents(life)[0]
    ratios_to_scratch = life.report["summary"].get(f"{name}_vs_scratch")
    if not ratios_to_scratch:
        return title
    ratios = {
        "steps": ratios_to_scratch["steps_to_80_ratio"]["value"],
        "collisions": ratios_to_scratch["collisions_ratio"]["value"],
    }
    parts = [f"{measure} × {_factor(value)}" for measure, value in ratios.items() if value is not None]
    period = "last third" if len(life.results) > 2 else "last task"
    return f"{title} — {name} compared with scratch, {period}: {', '.join(parts)}" if parts else title


def _factor(value: float) -> str:
    """Two decimals; one significant digit for values that two decimals would show as zero."""
    return f"{value:.2f}" if value >= 0.005 or value == 0 else f"{value:.1g}"


def _world_figure(life: Life, last: Sequence[GreedyPaths], lines: Mapping[int, Sequence[NDArray[np.float64]]]):
    """The ways of the last tasks, over the building's map or, in other worlds, over the cells."""
    world = life.world
    ways = [
        {
            "label": f"task {_named(task)}, {_arriving(life, task)}",
            "goal": lines[task.task][0][-1] if task.paths else task.goal_point or _point(world, task.goal),
            "paths": lines[task.task],
        }
        for task in last
    ]
    tasks = life.report["tasks"][: len(life.report["tasks"]) - len(last)]
    earlier = [task.get("position") or _point(world, int(world.state_of[tuple(task["goal"])])) for task in tasks]
    title = f"{_place(life)}: paths of {_agents(life)[0]} in its last {_count(len(last), 'task')}"
    return draw_world_map(_plan(life), ways, goals=earlier, title=title)


def _plan(life: Life) -> FloorPlan | MapPlan:
    if life.building is None:
        world = life.world
        return FloorPlan(world.shape, world.cells, world.neighbour)
    occupancy = life.building.occupancy
    return MapPlan(occupancy.grey, occupancy.resolution, occupancy.origin)


def _point(world: GridWorld, state: int) -> NDArray[np.float64]:
    return world.positions(np.array([state]))[0]


def _arriving(life: Life, task: GreedyPaths) -> str:
    if life.driven:
        return "driven" if task.arriving else "no way left"
    return f"reached from {_percent(task.arriving)} of starts"


def _named(task: GreedyPaths) -> str:
    return f"{task.task} ({task.name})" if task.name else str(task.task)


def _percent(share: float) -> str:
    """Percent, rounded down, so that 100 % means all."""
    return f"{int(100 * share)} %"


def _has_prior(life: Life) -> bool:
    return AGENTS[_agents(life)[0]].uses_prior and not life.lore.prior.unseen(life.world.percepts).all()


def _prior_figure(life: Life):
    prior, world = life.lore.prior, life.world
    probs, counted = prior.probs(world.percepts), ~prior.unseen(world.percepts)
    cell = world.frame.cell if life.report["domain"] == "building" else None
    title = f"{_place(life)}: the action prior given the surroundings of a cell"
    return draw_prior_map(world.shape, world.cells, world.neighbour, probs, counted, cell=cell, title=title)
