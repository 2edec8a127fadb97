"""A life in a building as data for a log: its map, costs, ways and events, with their times."""

from datetime import UTC, datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.live.goals.destinations import Point
from lifelore.agent.live.life import Life
from lifelore.agent.live.output.greedy_paths import GreedyPaths, last_paths, path_points
from lifelore.agent.live.output.known_building import KnownBuilding
from lifelore.agent.live.output.nav2_masks import NO_OPINION, on_map, place_costs, place_masks
from lifelore.core.errors import InputError
from lifelore.domains.buildings.logged_life import LoggedLife
from lifelore.domains.grids.grid_world import MOVE_NAMES


def logged_life(life: Life) -> LoggedLife:
    """The data of a life.

    Raises
    ------
    InputError
        The life has no building.
    """
    building = life.building
    if building is None:
        raise InputError(f"log needs a life in a building, got domain {life.report['domain']}; leave it out")
    tasks = {task["index"]: task for task in life.report["tasks"]}
    ways = [
        (_named(tasks[paths.task]), _seconds(tasks[paths.task]), points)
        for paths in last_paths(life)
        for points in _corners(life, building, paths)
    ]
    begin = min((_seconds(task) for task in tasks.values() if "clock" in task), default=np.inf)
    events = _ends(life, building, list(tasks.values())) + _refusals(building, begin)
    values = place_costs(building.costs, building.known), NO_OPINION
    (costs,) = place_masks(building.floor, building.known, values)
    laid = on_map(costs, building.floor, building.given, NO_OPINION)
    return LoggedLife(building.given, laid, ways, events)


def _ends(life: Life, building: KnownBuilding, tasks: list[dict[str, Any]]) -> list[tuple[str, float, Point]]:
    """When the first agent reached each goal, or gave it up."""
    ends = []
    for task, point in zip(tasks, goal_points(life, building, tasks), strict=True):
        found = next(iter(task["agents"].values()))
        word = "reached" if found["reached"] else "missed"
        driven = found["seconds"] if "clock" in task else 0.0
        ends.append((f"{word} {_named(task)}", _seconds(task) + driven, point))
    return ends


def _corners(life: Life, building: KnownBuilding, paths: GreedyPaths) -> list[NDArray[np.float64]]:
    """The ways of a task that was driven; of a searched goal the first path that was learnt."""
    if life.driven:
        return [building.floor.metres(building.floor.anchors[states]) for states in paths.paths]
    return path_points(life.world, paths, building.floor)[:1]


def goal_points(life: Life, building: KnownBuilding, tasks: list[dict[str, Any]]) -> list[Point]:
    """The goals of tasks: the user's points, or those of their cells that are farthest from obstacles."""
    states = np.array([life.world.state_of[tuple(task["goal"])] for task in tasks], np.int64)
    anchors = building.floor.metres(building.floor.anchors[states])
    return [tuple(task.get("position") or point) for task, point in zip(tasks, anchors.tolist(), strict=True)]


def _refusals(building: KnownBuilding, begin: float) -> list[tuple[str, float, Point]]:
    passes = building.travel.passes
    chosen = passes.where((passes.refusals > 0) & (passes.minute * 60 >= begin - 60))
    state, action = chosen.move // len(MOVE_NAMES), chosen.move % len(MOVE_NAMES)
    points = building.floor.metres(building.floor.anchors[state]).tolist()
    return [
        (f"refused {MOVE_NAMES[move]}", 60.0 * minute, (x, y))
        for move, minute, (x, y) in zip(action, chosen.minute.tolist(), points, strict=True)
    ]


def _named(task: dict[str, Any]) -> str:
    return task.get("name") or f"goal {task['index']}"


def _seconds(task: dict[str, Any]) -> float:
    if "clock" not in task:
        return float(task["index"])
    return datetime.fromisoformat(task["clock"]).replace(tzinfo=UTC).timestamp()
