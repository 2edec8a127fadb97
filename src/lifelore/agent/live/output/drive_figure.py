"""The picture of driven jobs: time lost by each agent, and the floor as it was learnt."""

import numpy as np

from lifelore.agent.live.life import Life
from lifelore.agent.travel.edge_times import nominal_seconds
from lifelore.figures.lives.drives import LearntFloor, draw_drives


def drives_figure(life: Life, place: str):
    """Minutes that each agent lost, beside what was learnt; `place` names the building."""
    tasks = life.report["tasks"]
    totals = life.report["summary"].get("lore_vs_map_only", {}).get("all")
    title = f"{len(tasks):,} jobs driven in {place}"
    if totals and totals["seconds_ratio"]["value"] is not None:
        title += f": seconds with memory × {totals['seconds_ratio']['value']:.2f} of those on the map alone"
    lost = lost_time(life.report, nominal_seconds(life.world) / life.world.frame.cell)
    return draw_drives([task["index"] for task in tasks], lost, learnt_floor(life), title=title)


def lost_time(report: dict, pace: float) -> dict[str, dict[str, list[float]]]:
    """The seconds ``lost`` and the ``refusals`` of each job, by agent; `pace` is in nominal seconds a metre."""
    tasks = report["tasks"]
    return {
        name: {
            "lost": [task["agents"][name]["seconds"] - pace * task["map_metres"] for task in tasks],
            "refusals": [task["agents"][name]["refusals"] for task in tasks],
        }
        for name in tasks[0]["agents"]
    }


def learnt_floor(life: Life) -> LearntFloor:
    """What was learnt by the end of a life, at noon of its last day."""
    world, travel = life.world, life.travel
    assert travel is not None, "goals were driven to"
    passes = travel.passes
    state, into = passes.move // 4, world.neighbour.ravel()[passes.move]
    minute = int(passes.minute.max(initial=0))
    expected = travel.seconds(60.0 * (minute // 1440 * 1440 + 720)) / nominal_seconds(world)
    observed = np.isin(np.arange(world.n_states), np.r_[state, into])
    delay = np.where(observed, np.where(world.neighbour >= 0, expected, -np.inf).max(axis=1), np.nan)
    refused = world.cells[np.unique(into[passes.refusals > 0])]
    return LearntFloor(world.shape, world.cells, world.neighbour, delay, refused, world.frame.cell)
