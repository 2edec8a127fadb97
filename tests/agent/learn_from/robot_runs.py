"""Runs of a robot that drives shortest paths through a building, as a log in metres."""

from itertools import pairwise

import numpy as np

from lifelore.agent.learn_from.run_log import Run
from lifelore.core.planning.planning import greedy_policy, optimal_q
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld


def driven_path(world: GridWorld, start: int, goal: int) -> list[int]:
    """States of a shortest path."""
    policy = greedy_policy(optimal_q(world.task(goal).tables(), world.discount))
    path = [start]
    while path[-1] != goal:
        path.append(int(world.neighbour[path[-1], policy[path[-1]]]))
    return path


def driven_run(world: GridWorld, number: int, noise: float = 0.02, outcome: str = "goal") -> Run:
    """A run between two random places, with a pose every 0.1 m or so, and localisation noise in metres."""
    draw = stream(5, "runs", number)
    start, goal = (int(state) for state in draw.choice(world.n_states, 2, replace=False))
    corners = world.positions(np.array(driven_path(world, start, goal)))
    pieces = [np.linspace(a, b, 6)[:-1] for a, b in pairwise(corners)]
    points = np.vstack([*pieces, corners[-1:]])
    points[1:-1] += draw.normal(0, noise, points[1:-1].shape)
    n = len(points)
    return Run(str(number), np.arange(n) * 0.2, points, np.full(n, np.nan), [*[""] * (n - 1), outcome])


def csv_text(runs: list[Run]) -> str:
    """The runs as the text of a log."""
    lines = ["run,time,x,y,outcome"]
    for run in runs:
        for time, (x, y), outcome in zip(run.time, run.points, run.outcome, strict=True):
            lines.append(f"{run.name},{time:.2f},{x:.3f},{y:.3f},{outcome}")
    return "\n".join(lines) + "\n"
