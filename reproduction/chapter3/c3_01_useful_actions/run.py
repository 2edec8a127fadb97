"""C3.1: which share of the actions of a small maze is ever useful.

The printed shares determine the size of the mazes: 55.26 % = 42/76 and 63.16 % = 48/76 need 19 free cells, that
is 6 obstacles in the 25 cells inside the wall. The thesis does not state how they were placed; there are two
generators: one walls up cells one at a time without parting the rest, one is uniform over all connected mazes.
Thesis: §3.2.2.2, Figure 3.1.
"""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.grids.noise_maze import noise_maze
from lifelore.figures.lives.prior_arrows import draw_prior
from lifelore.figures.style import BLUE, GREY, SKY, VERMILION, Axes, Figure, new_figure
from reproduction.chapter3.learning.grid_tasks import problem_of

PRINTED, PRINTED_OF = (42, 48), 76
"""Useful actions in the two mazes of Figure 3.1, and all actions there."""
CHUNK = 100
"""Mazes a cell of the run."""
MAX_DRAWS = 20_000


def cells(settings: Mapping) -> list[dict]:
    """Mazes in chunks, by generator."""
    firsts = range(0, settings["mazes"], CHUNK)
    return [{"generator": g, "first": first} for g in settings["generators"] for first in firsts]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Counts of actions in each maze of a chunk, and an example of each printed share."""
    generator, (size, obstacles) = cell["generator"], (settings["size"], settings["obstacles"])
    found = {"generator": generator, "mazes": [], "examples": {}}
    for number in range(cell["first"], min(cell["first"] + CHUNK, settings["mazes"])):
        random = stream(seed, "C3.1", generator, number)
        if generator == "walled up":
            world = noise_maze(random, size, obstacles=obstacles, discount=settings["discount"])
        else:
            world = uniform_maze(random, size, obstacles, settings["discount"])
        goals = random.integers(world.n_states, size=settings["tasks"])
        prior = prior_of(world, goals)
        found["mazes"].append(_counts(world, prior))
        useful = found["mazes"][-1]["useful"]
        if useful in PRINTED:
            found["examples"].setdefault(str(useful), _example(world, prior))
    return found


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


def prior_of(world: GridWorld, goals: NDArray[np.int64]) -> ActionPrior:
    """The prior from exact optimal policies, without the goals' own rows (E3)."""
    prior = ActionPrior(4)
    for goal, times in zip(*np.unique(goals, return_counts=True), strict=True):
        prior.update(np.arange(world.n_states), problem_of(world, int(goal), ()).best, weight=float(times))
    return prior


def _counts(world: GridWorld, prior: ActionPrior) -> dict:
    useful, passable = prior.counts(np.arange(world.n_states)) > 0, world.neighbour >= 0
    return {"actions": useful.size, "useful": int(useful.sum()), "passable": int(passable.sum())}


def _example(world: GridWorld, prior: ActionPrior) -> dict:
    states = np.arange(world.n_states)
    counts = prior.counts(states)
    return {
        "shape": list(world.shape),
        "cells": world.cells.tolist(),
        "probs": (counts / counts.sum(axis=1, keepdims=True)).tolist(),
        "counted": (~prior.unseen(states)).tolist(),
    }


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The same for each generator."""
    for generator in settings["generators"]:
        yield {"generator": generator}, _shares(_mazes(results, generator))


def _mazes(results: Sequence[Mapping], generator: str) -> list[Mapping]:
    return [maze for result in results if result["generator"] == generator for maze in result["mazes"]]


def _shares(mazes: Sequence[Mapping]) -> dict[str, Estimate]:
    counts = {key: np.array([maze[key] for maze in mazes], float) for key in mazes[0]}
    found = {"passable_found_useful": mean_estimate(counts["useful"] / counts["passable"])}
    for printed in PRINTED:
        # Mid-ranks: of the mazes that have exactly this share, half count as below.
        apart = counts["useful"] / counts["actions"] - printed / PRINTED_OF
        rank = (apart < -1e-9) + 0.5 * (abs(apart) < 1e-9)
        found[f"rank_of_{printed}_of_{PRINTED_OF}"] = mean_estimate(rank)
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """How many mazes have each number of useful actions, and one maze for each printed share."""
    found = []
    for generator in settings["generators"]:
        counts = Counter((maze["useful"], maze["actions"]) for maze in _mazes(results, generator))
        found += [
            {"generator": generator, "useful": useful, "actions": actions, "mazes": n}
            for (useful, actions), n in sorted(counts.items())
        ]
    for printed in map(str, PRINTED):
        examples = (r["examples"][printed] for r in results if printed in r["examples"])
        found += [{"example": int(printed), **example} for example in examples][:1]
    return found


def draw(result: Mapping) -> Figure:
    """Figure of claim C3.1: two mazes with their useful actions, and the useful shares of all mazes.

    The figure from the result: examples that its rows hold, then the spread of shares.
    """
    examples = [row for row in result["rows"] if "example" in row]
    figure = new_figure(9.2, 2.9)
    widths = [1.0] * len(examples) + [1.75]
    panels = figure.subplots(1, len(widths), squeeze=False, gridspec_kw={"width_ratios": widths})[0]
    for axes, row in zip(panels, examples, strict=False):
        draw_prior(axes, row["shape"], row["cells"], row["probs"], row["counted"], negligible=0.0)
        axes.set_anchor("N")
        axes.set_title(f"{row['example']} of {4 * len(row['cells'])} actions useful")
    _draw_shares(panels[-1], result)
    return figure


def _draw_shares(axes: Axes, result: Mapping) -> None:
    """Shares of mazes by useful share, bars for each generator; a line for each printed share."""
    from matplotlib.ticker import MaxNLocator

    generators = result["settings"]["generators"]
    for place, (generator, colour) in enumerate(zip(generators, (BLUE, SKY, GREY), strict=False)):
        rows = [row for row in result["rows"] if row.get("generator") == generator]
        share = np.array([row["useful"] / row["actions"] for row in rows])
        mazes = np.array([row["mazes"] for row in rows])
        width = 100 / rows[0]["actions"] / (len(generators) + 0.35)
        beside = 100 * share + width * (place - (len(generators) - 1) / 2)
        axes.bar(beside, 100 * mazes / mazes.sum(), width, color=colour, label=generator)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, steps=[1, 5, 10]))
    top = axes.get_ylim()[1] * 1.2
    for share in (100 * printed / PRINTED_OF for printed in PRINTED):
        axes.axvline(share, color=VERMILION, linewidth=1.3, zorder=0)
        axes.annotate(
            f"thesis: {share:.2f} %", (share, top), (4, -1), textcoords="offset points",
            va="top", fontsize=7.5, color=VERMILION,
        )  # fmt: skip
    axes.set(ylim=(0, top), xlabel="useful share of all actions (%)", ylabel="share of mazes (%)")
    axes.set_title(f"Over {result['settings']['mazes']:,} mazes of either kind")
    axes.legend(loc="upper right", bbox_to_anchor=(1.02, 0.93), title="obstacles", title_fontsize=8)
