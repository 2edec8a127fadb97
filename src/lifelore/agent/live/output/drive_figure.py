"""The picture of driven jobs: time lost by each agent, and the floor as it was learnt."""

import numpy as np

from lifelore.agent.live.life import Life
from lifelore.agent.travel.travel import Travel
from lifelore.domains.buildings.busy_building import SPEED
from lifelore.figures.lives.drives import LearntFloor, draw_drives


def drives_figure(life: Life, place: str):
    """Minutes that each agent lost, beside what was learnt; `place` names the building."""
    assert life.building is not None, "goals were driven to"
    tasks = life.report["tasks"]
    totals = life.report["summary"].get("lore_vs_map_only", {}).get("all")
    title = f"{len(tasks):,} jobs driven in {place}"
    if totals and totals["seconds_ratio"]["value"] is not None:
        title += f": seconds with memory × {totals['seconds_ratio']['value']:.2f} of those on the map alone"
    return draw_drives(
        [task["index"] for task in tasks], lost_time(life.report), learnt_floor(life.building.travel), title=title
    )


def lost_time(report: dict) -> dict[str, dict[str, list[float]]]:
    """The ``refusals`` of each job by agent, and the seconds ``lost`` beside the shortest way at full speed."""
    tasks = report["tasks"]
    return {
        name: {
            "lost": [task["agents"][name]["seconds"] - task["map_metres"] / SPEED for task in tasks],
            "refusals": [task["agents"][name]["refusals"] for task in tasks],
        }
        for name in tasks[0]["agents"]
    }


def learnt_floor(travel: Travel) -> LearntFloor:
    """What was learnt of a building, as it is at noon of the last day on which something was observed."""
    world, passes = travel.world, travel.passes
    state, into = passes.move // 4, world.neighbour.ravel()[passes.move]
    minute = int(passes.minute.max(initial=0))
    expected = travel.seconds(60.0 * (minute // 1440 * 1440 + 720)) * SPEED / world.frame.cell
    observed = np.isin(np.arange(world.n_states), np.r_[state, into])
    delay = np.where(observed, np.where(world.neighbour >= 0, expected, -np.inf).max(axis=1), np.nan)
    refused = world.cells[np.unique(into[passes.refusals > 0])]
    return LearntFloor(world.shape, world.cells, world.neighbour, delay, refused, world.frame.cell)
