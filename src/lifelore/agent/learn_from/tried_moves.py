"""Turns the poses of a run into moves of a building: made, refused, or contradicting the map.

Between two poses the robot is taken to have driven straight. A move between two cells that the map separates is
not learnt: a pose that is 10 cm off hops through a thin wall. Poses that tremble across the border of two cells
are no moves. A bump counts also where the map is free, because the robot met an obstacle that the map lacks.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.learn_from.run_log import BUMP, Run
from lifelore.domains.grids.grid_world import GridWorld

FARTHEST = 2.0
"""Cells: the longest straight piece between two poses; over a longer one the way of the robot is not known."""
PER_CELL = 20
"""Points on a straight piece, for each cell of its length."""
AT_REST = 0.02
"""Metres that a robot has to move for its direction to be known."""
TREMBLE, MOST_TREMBLE = 0.02, 0.25
"""Least depth in metres to which a robot enters a cell that it leaves by the same border, and the largest share of
a cell that noise can make it."""
SHORTEST = 0.5
"""Cells: the shortest straight way between two crossings that has a time; a shorter one counts with the next."""


@dataclass(frozen=True, eq=False)
class TriedMoves:
    """Moves of a run in a building, in order of time.

    states, actions, targets : (n,) int
        The cell, the move, and the cell that it led to: the same cell after a bump.
    time : (n,) float
        Seconds of the run's clock at which the robot crossed the border, or bumped.
    seconds : (n,) float
        Seconds for the side of a cell at the robot's speed since an earlier crossing, waiting included, or at the
        speed of the crossing where none was seen since a gap; NaN for bumps, where the robot turned back, and
        where it came less than `SHORTEST` cells far.
    new_obstacles : (n,) bool
        Bumps where the map is free.
    gaps, contradictions, undirected : int
        Pairs of poses that are too far apart; moves between neighbouring cells that the map separates; bumps whose
        direction is not known.
    """

    states: NDArray[np.int64]
    actions: NDArray[np.int64]
    targets: NDArray[np.int64]
    time: NDArray[np.float64]
    seconds: NDArray[np.float64]
    new_obstacles: NDArray[np.bool_]
    gaps: int
    contradictions: int
    undirected: int

    @property
    def made(self) -> NDArray[np.bool_]:
        """(n,) whether the move led to another cell."""
        return self.states != self.targets


@dataclass(frozen=True)
class _Crossing:
    """A border that the robot crossed, in the straight piece between pose `pose` and the next."""

    pose: int
    time: float
    point: NDArray[np.float64]
    state: int
    action: int
    target: int
    slowness: float


def tried_moves(world: GridWorld, run: Run, noise: float = 0.0) -> TriedMoves:
    """The moves that a robot tried in a run; `noise` in metres is that of its poses, see `localisation_noise`."""
    here = world.states_at(run.points)
    apart = np.hypot(*np.diff(run.points, axis=0).T) > FARTHEST * world.frame.cell
    gap = apart | (here[1:] < 0) | (here[:-1] < 0)
    crossings, contradictions = _crossings(world, run, np.flatnonzero(~gap))
    depth = min(max(TREMBLE, 2 * noise), MOST_TREMBLE * world.frame.cell)
    crossings = _without_tremble(crossings, run, world.move_vectors, depth)
    bumps, undirected = _bumps(world, run, here)
    rows = [(one.state, one.action, one.target) for one in crossings] + [(s, a, s) for _, s, a in bumps]
    steps = np.array(rows, np.int64).reshape(-1, 3)
    time = np.array([one.time for one in crossings] + [run.time[i] for i, _, _ in bumps])
    taken = _seconds(crossings, np.concatenate([[0], np.cumsum(gap)]), world.frame.cell)
    seconds = np.array(taken + [np.nan] * len(bumps))
    order = np.argsort(time, kind="stable")
    states, actions, targets = steps[order].T
    new = (states == targets) & (world.neighbour[states, actions] >= 0)
    return TriedMoves(
        states, actions, targets, time[order], seconds[order], new, int(gap.sum()), contradictions, undirected
    )


def _crossings(world: GridWorld, run: Run, pairs: NDArray[np.int64]) -> tuple[list[_Crossing], int]:
    """Borders crossed between the poses of `pairs` and the next ones; and the number of walls among them."""
    piece = run.points[pairs + 1] - run.points[pairs]
    length, duration = np.hypot(*piece.T), run.time[pairs + 1] - run.time[pairs]
    parts = np.maximum(1, np.ceil(length / world.frame.cell * PER_CELL)).astype(int)
    of = np.repeat(np.arange(len(pairs)), parts + 1)
    share = (np.arange(len(of)) - np.repeat(np.cumsum(parts + 1) - parts - 1, parts + 1)) / parts[of]
    along = world.states_at(run.points[pairs][of] + share[:, None] * piece[of])
    changes = np.flatnonzero(
        (along[1:] != along[:-1]) & (of[1:] == of[:-1]) & (along[1:] >= 0) & (along[:-1] >= 0)
    )
    crossings, contradictions = [], 0
    for at in changes.tolist():
        state, target, pair = int(along[at]), int(along[at + 1]), of[at]
        action = np.flatnonzero(world.neighbour[state] == target)
        if len(action):
            middle = (share[at] + share[at + 1]) / 2
            crossings.append(_Crossing(
                int(pairs[pair]), run.time[pairs[pair]] + middle * duration[pair],
                run.points[pairs[pair]] + middle * piece[pair], state, int(action[0]), target,
                duration[pair] / length[pair],
            ))  # fmt: skip
        elif np.abs(world.cells[state] - world.cells[target]).sum() == 1:
            contradictions += 1
    return crossings, contradictions


def _without_tremble(
    crossings: list[_Crossing], run: Run, vectors: NDArray[np.float64], depth: float
) -> list[_Crossing]:
    """The crossings without those into a cell that the robot left at once, after `depth` metres at most."""
    kept: list[_Crossing] = []
    for one in crossings:
        if kept and (kept[-1].state, kept[-1].target) == (one.target, one.state):
            last = kept[-1]
            between = slice(last.pose + 1, one.pose + 1)
            deepest = ((run.points[between] - last.point) @ vectors[last.action]).max(initial=0.0)
            if deepest <= depth and BUMP not in run.outcome[between]:
                kept.pop()
                continue
        kept.append(one)
    return kept


def _seconds(crossings: list[_Crossing], gaps: NDArray[np.int64], cell: float) -> list[float]:
    """Seconds of each crossing's move, see `TriedMoves`; `gaps` counts the gaps before each pose."""
    taken = [one.slowness * cell for one in crossings]
    start = 0
    for i, (last, one) in enumerate(pairwise(crossings), start=1):
        if gaps[last.pose] != gaps[one.pose]:
            start = i
        elif last.state == one.target:
            taken[i], start = np.nan, i
        elif (far := np.hypot(*(one.point - crossings[start].point))) < SHORTEST * cell:
            taken[i] = np.nan
        else:
            taken[i], start = (one.time - crossings[start].time) * cell / far, i
    return taken


def _bumps(world: GridWorld, run: Run, here: NDArray[np.int32]) -> tuple[list[tuple[int, int, int]], int]:
    """(pose, state, action) of each bump whose direction is known, and the number of the others."""
    bumps, undirected = [], 0
    for i, outcome in enumerate(run.outcome):
        if outcome != BUMP or here[i] < 0:
            continue
        direction = _direction(run, i)
        if direction is None:
            undirected += 1
        else:
            bumps.append((i, int(here[i]), int(np.argmax(world.move_vectors @ direction))))
    return bumps, undirected


def _direction(run: Run, i: int) -> NDArray[np.float64] | None:
    """The direction in which the robot drove at pose `i`: its heading, or else where it came from."""
    if np.isfinite(run.heading[i]):
        return np.array([np.cos(run.heading[i]), np.sin(run.heading[i])])
    for j in range(i - 1, -1, -1):
        moved = run.points[i] - run.points[j]
        if np.hypot(*moved) >= AT_REST:
            return moved / np.hypot(*moved)
    return None
