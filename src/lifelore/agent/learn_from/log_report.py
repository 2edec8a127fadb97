"""Checks a log against the map before anything is stored, and reports what it teaches."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from lifelore.agent.learn_from.learnt_runs import LearntRun
from lifelore.agent.learn_from.log_fit import MENDED, MOST_OUTSIDE, Reachable, mending_shift
from lifelore.agent.learn_from.run_log import Run
from lifelore.agent.learn_from.tried_moves import TriedMoves
from lifelore.agent.live.buildings.recognition import Place
from lifelore.core.errors import InputError
from lifelore.domains.grids.grid_world import MOVE_NAMES

MUCH_NOISE, MOST_NOISE = 0.2, 0.4
"""Standard deviation of the poses, as a share of a cell, from which a log gives a warning, and is refused."""
MANY_CONTRADICTIONS = 0.05
"""Share of the moves that the map separates, from which a log gives a warning."""


def checked_log(runs: Sequence[Run], reachable: Reachable, noise: float, cell: float, source: str) -> int:
    """The number of poses outside.

    Raises
    ------
    InputError
        The poses tremble too much for the cells, or more than `MOST_OUTSIDE` of them lie outside; the message
        names the offset that mends the log, if there is one.
    """
    points = np.concatenate([run.points for run in runs])
    outside = int(reachable.outside(points).sum())
    if noise > MOST_NOISE * cell and 2 * outside < len(points):  # in millimetres all poses lie outside
        raise InputError(
            f"{source}: the poses tremble by {noise:.2f} m (standard deviation), too much for cells of {cell:g} m;"
            " smooth the log, or take a larger cell"
        )
    if outside > MOST_OUTSIDE * len(points):
        found = mending_shift(points, reachable)
        raise InputError(
            f"{source}: {outside:,} of {len(points):,} poses lie where the robot cannot be on this map "
            f"(at most {MOST_OUTSIDE:.0%} may); {_advice(found)}"
        )
    return outside


def _advice(found: tuple[tuple[float, float, float], float] | None) -> str:
    if found is None:
        return "no single offset mends it; give the map on which the robot drove, metres, or its --robot-radius"
    (x, y, yaw), share = found
    return f"--shift={x:g},{y:g},{yaw:g} leaves {share:.1%}: add it if the log has another origin than the map"


def log_report(
    place: Place, learnt: Sequence[LearntRun], source: str, outside: int, noise: float
) -> dict[str, Any]:
    """The report of `learn_from`, without what is known after storing."""
    tried = [one.tried for one in learnt]
    made = sum(int(one.made.sum()) for one in tried)
    report = {
        "source": source,
        "building": place.report,
        "runs": len(learnt),
        "to_goal": sum(one.goal is not None for one in learnt),
        "poses": sum(len(one.run.time) for one in learnt),
        "moves": made,
        "bumps": sum(len(one.states) for one in tried) - made,
        "new_obstacles": [row for one in tried for row in _new_obstacles(place, one)],
        "outside": outside,
        "noise": round(noise, 3),
        "gaps": sum(one.gaps for one in tried),
        "contradictions": sum(one.contradictions for one in tried),
        "undirected": sum(one.undirected for one in tried),
    }
    report["warnings"] = list(_warnings(report, place.world.frame.cell))
    return report


def _new_obstacles(place: Place, tried: TriedMoves) -> Iterator[list]:
    """x, y in metres of the cell, and the name of the move, of each bump where the map is free."""
    states, actions = tried.states[tried.new_obstacles], tried.actions[tried.new_obstacles]
    for (x, y), action in zip(place.world.positions(states.astype(np.int32)), actions, strict=True):
        yield [round(float(x), 3), round(float(y), 3), MOVE_NAMES[action]]


def _warnings(report: dict[str, Any], cell: float) -> Iterator[str]:
    if report["noise"] > MUCH_NOISE * cell:
        yield f"the poses tremble by {report['noise']:.2f} m (standard deviation); some moves may be wrong"
    if report["outside"] > MENDED * report["poses"]:
        yield f"{report['outside']:,} of {report['poses']:,} poses lie where the robot cannot be on this map"
    if report["contradictions"] > MANY_CONTRADICTIONS * max(report["moves"], 1):
        yield (
            f"{report['contradictions']:,} moves go through walls of the map and were not learnt; the log and the "
            "map may have different frames"
        )
    if not report["moves"]:
        yield "no move was learnt: the poses are too far apart, or the robot stayed in its cells"
    if not report["to_goal"]:
        yield "no run ended with the outcome goal, so the action prior learnt nothing"
