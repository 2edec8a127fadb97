"""C3.1: which share of the actions of a small maze is ever useful.

In 7 × 7 walled mazes, 50 random goals each, the prior from exact optimal policies gives mass to some of the 4
actions of each cell. The printed shares pin the mazes down: 55.26 % = 42/76 and 63.16 % = 48/76 need 19 free
cells, that is 6 obstacles in the 25 cells inside the wall. How the obstacles were thrown is not stated, so two
ways are measured: walled up one at a time without parting the rest, and uniform over all connected mazes.
Thesis: §3.2.2.2, Figure 3.1.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.planning.planning import best_actions, optimal_q
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.grids.noise_maze import noise_maze
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.estimates import quantile_estimate
from lifelore.experiments.engine.predicate import Predicate

PRINTED = (42, 48)
"""Useful actions, of 76, in the two mazes of Figure 3.1."""
CHUNK = 100
MAX_DRAWS = 20_000
GENERATORS = ("walled up", "uniform")

FULL = {
    "size": 7,
    "obstacles": 6,
    "tasks": 50,
    "mazes": 2000,
    "discount": 0.95,
    "generators": list(GENERATORS),
}
QUICK = {**FULL, "mazes": 60}


def _check(settings: Mapping) -> None:
    unknown = set(settings["generators"]) - set(GENERATORS)
    if unknown or not settings["generators"]:
        raise InputError(f"generators must be among {', '.join(GENERATORS)}, got {settings['generators']}")
    if settings["mazes"] < 1 or settings["tasks"] < 1:
        raise InputError(f"mazes and tasks must be at least 1, got {settings['mazes']} and {settings['tasks']}")


def cells(settings: Mapping) -> list[dict]:
    """Mazes in lots of `CHUNK`, by generator."""
    firsts = range(0, settings["mazes"], CHUNK)
    return [{"generator": g, "first": first} for g in settings["generators"] for first in firsts]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Counts of actions in each maze of a lot, and an example of each share that the thesis prints."""
    last = min(cell["first"] + CHUNK, settings["mazes"])
    found = {"generator": cell["generator"], "mazes": [], "examples": {}}
    for number in range(cell["first"], last):
        random = stream(seed, "C3.1", cell["generator"], number)
        world = _maze(settings, cell["generator"], random)
        goals = random.integers(world.n_states, size=settings["tasks"])
        prior = prior_of(world, goals)
        found["mazes"].append(_counts(world, prior, goals))
        useful = found["mazes"][-1]["useful"]
        if useful in PRINTED:
            found["examples"].setdefault(str(useful), _example(world, prior))
    return found


def _maze(settings: Mapping, generator: str, random: np.random.Generator) -> GridWorld:
    size, obstacles = settings["size"], settings["obstacles"]
    if generator == "walled up":
        return noise_maze(random, size, obstacles=obstacles, discount=settings["discount"])
    return uniform_maze(random, size, obstacles, settings["discount"])


def uniform_maze(random: np.random.Generator, size: int, obstacles: int, discount: float) -> GridWorld:
    """A maze drawn uniformly from all connected ones with so many obstacles: drawn until it is connected."""
    inside = (size - 2) ** 2
    for _ in range(MAX_DRAWS):
        free = np.zeros((size, size), bool)
        free[1:-1, 1:-1] = (random.permutation(inside) >= obstacles).reshape(size - 2, size - 2)
        if ndimage.label(free)[1] == 1:  # type: ignore[index]
            return GridWorld.from_free("noise", free, discount=discount)
    raise InputError(
        f"obstacles: none of {MAX_DRAWS:,} mazes with {obstacles} obstacles at size {size} was connected; "
        "use fewer, or the generator 'walled up'"
    )


def prior_of(world: GridWorld, goals: NDArray[np.int64], goal_rows: bool = False) -> ActionPrior:
    """The prior from exact optimal policies; `goal_rows` counts every goal's own row too, as one must not."""
    prior = ActionPrior(4)
    for goal, times in zip(*np.unique(goals, return_counts=True), strict=True):
        best = best_actions(optimal_q(world.task(int(goal)).tables(), world.discount))
        best[goal] = goal_rows  # at the goal every action ties: nothing was chosen there
        prior.update(np.arange(world.n_states), best, weight=float(times))
    return prior


def _counts(world: GridWorld, prior: ActionPrior, goals: NDArray[np.int64]) -> dict:
    useful, passable = _useful(world, prior), world.neighbour >= 0
    with_goals = _useful(world, prior_of(world, goals, goal_rows=True))
    return {
        "actions": useful.size,
        "useful": int(useful.sum()),
        "passable": int(passable.sum()),
        "useful_collisions": int((useful & ~passable).sum()),
        "useful_with_goal_rows": int(with_goals.sum()),
    }


def _useful(world: GridWorld, prior: ActionPrior) -> NDArray[np.bool_]:
    return prior.counts(np.arange(world.n_states)) > 0


def _example(world: GridWorld, prior: ActionPrior) -> dict:
    states = np.arange(world.n_states)
    counts = prior.counts(states)
    return {
        "shape": list(world.shape),
        "cells": world.cells.tolist(),
        "probs": (counts / counts.sum(axis=1, keepdims=True)).tolist(),
        "counted": (~prior.unseen(states)).tolist(),
    }


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares over mazes, for each way of making them."""
    found = {}
    for generator in settings["generators"]:
        mazes = [m for r in results if r["generator"] == generator for m in r["mazes"]]
        table = {key: np.array([m[key] for m in mazes], float) for key in mazes[0]}
        suffix = "_" + generator.replace(" ", "_")
        share = table["useful"] / table["actions"]
        found[f"useful_share{suffix}"] = mean_estimate(share)
        found[f"useful_share_2.5_percent_point{suffix}"] = quantile_estimate(share, 0.025)
        found[f"useful_share_97.5_percent_point{suffix}"] = quantile_estimate(share, 0.975)
        for printed in PRINTED:
            # Mid-ranks: of the mazes that have exactly this share, half count as below.
            rank = (share < printed / 76 - 1e-9) + 0.5 * (abs(share - printed / 76) < 1e-9)
            found[f"rank_of_{printed}_of_76{suffix}"] = mean_estimate(rank)
        found[f"passable_found_useful{suffix}"] = mean_estimate(table["useful"] / table["passable"])
        found[f"useful_that_collide{suffix}"] = mean_estimate(table["useful_collisions"] / table["useful"])
        found[f"mazes_where_useful_is_passable{suffix}"] = mean_estimate(table["useful"] == table["passable"])
        found[f"useful_share_goal_rows_counted{suffix}"] = mean_estimate(
            table["useful_with_goal_rows"] / table["actions"]
        )
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """How many mazes have each number of useful actions, and one maze for each printed share."""
    found = []
    for generator in settings["generators"]:
        mazes = [m for r in results if r["generator"] == generator for m in r["mazes"]]
        pairs = [(m["useful"], m["actions"]) for m in mazes]
        for useful, actions in sorted(set(pairs)):
            count = pairs.count((useful, actions))
            found.append({"generator": generator, "useful": useful, "actions": actions, "mazes": count})
    for printed in map(str, PRINTED):
        examples = (r["examples"][printed] for r in results if printed in r["examples"])
        found += [{"example": int(printed), **example} for example in examples][:1]
    return found


def _draw(result: Mapping):
    from lifelore.experiments.chapter3.c3_01_useful_actions.figure_useful_actions import draw_useful_actions

    return draw_useful_actions(result, [printed / 76 for printed in PRINTED])


CLAIM = Claim(
    id="C3.1",
    title="Useful actions in small mazes (Figure 3.1)",
    thesis="In two 7×7 mazes, the prior from the optimal policies of 50 random tasks keeps 55.26 % and 63.16 % of "
    "the actions; the useful ones are those that do not collide.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C3.1"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    check=_check,
)
