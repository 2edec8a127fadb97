"""C3.16: Q-learning on errands of a maze, with advice in its ε branch and without.

Readings look at the first episodes alone, which show whether the goal is found in a handful; at the default all
episodes are learnt. Tasks of one maze are not independent: intervals are over mazes. Thesis: §3.7.2, Figure 3.22.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.action.advice.advisor import Advisor
from lifelore.core.metrics import Estimate
from lifelore.figures.style import Axes
from reproduction.chapter3.advice import mazes
from reproduction.chapter3.advice.learning import errand_tables, final_reward, learner_schedule, reached_by_learner
from reproduction.chapter3.advice.mazes import ADVICE_COLOURS, Maze
from reproduction.chapter3.learning.grid_tasks import block_curve
from reproduction.chapter3.learning.schedules import Epsilon
from reproduction.engine.grid import combinations
from reproduction.engine.records import having, in_blocks
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

cells = mazes.maze_cells
HANDFUL = 10
"""Episodes within which a goal must be found."""
DRAWN = 20
"""Tasks of the figure, those of the first mazes."""
WAYS = ("plain", "advised")


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze: goals found in a handful of episodes by reading; at the default all episodes of both learners."""
    maze = mazes.maze_of(settings, cell, seed)
    advisors = [
        mazes.thesis_advisor(mazes.goal_models_of(maze, **choice)) for choice in mazes.choices_of(settings)
    ]
    silent = mazes.thesis_advisor(mazes.goal_models_of(maze, **mazes.choices_of(settings)[0]), float("inf"))

    def found_by(advisor: Advisor) -> list[float]:
        return [
            float(np.mean(_reached(settings, maze, advisor, starts, epsilon, HANDFUL).any(axis=1)))
            for starts, epsilon in product(settings["starts"], settings["schedule"])
        ]

    found = {"plain": found_by(silent), "advised": [found_by(advisor) for advisor in advisors]}
    if cell["loops"] == settings["loops"][0]:
        default = settings["starts"][0], settings["schedule"][0]
        curves = [_reached(settings, maze, advisor, *default) for advisor in (silent, advisors[0])]
        drawn = cell["maze"] * settings["tasks"] < DRAWN
        for way, reached in zip(WAYS, curves, strict=True):
            found[f"final_{way}"] = float(np.mean([final_reward(of_task) for of_task in reached]))
            found[f"curve_{way}"] = np.round(1000 * in_blocks(reached)).tolist() if drawn else []
    return {**cell, **found}


def _reached(
    settings: Mapping, maze: Maze, advisor: Advisor, starts: str, epsilon: Epsilon, first: int | None = None
) -> NDArray[np.bool_]:
    """Which episodes of each task reached its goal, (n_tasks, n_episodes); only the `first` ones."""
    schedule = learner_schedule(settings, maze, epsilon, first)
    return np.array([
        reached_by_learner(maze, errand_tables(maze, errand, number, starts), number, schedule, advisor)
        for number, errand in enumerate(mazes.errands_of(maze, settings["tasks"]))
    ])  # fmt: skip


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The reward at the end, at the default."""
    own = having(results, loops=settings["loops"][0])
    return {f"final_{way}": mazes.maze_estimate([result[f"final_{way}"] for result in own]) for way in WAYS}


def _found(results: Sequence[Mapping], place: int, use: int) -> dict[str, Estimate]:
    plain, advised = (
        np.array([by_use[use] for by_use in values])
        for values in ([r["plain"] for r in results], [r["advised"][place] for r in results])
    )
    return {
        "found_plain": mazes.maze_estimate(plain),
        "found_advised": mazes.maze_estimate(advised),
        "found_gain": mazes.maze_estimate(advised - plain),
    }


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """Goals found in a handful by loops, experts, α⁰, starts and schedule."""
    uses = combinations(settings, ("starts", "schedule"))
    for loops in settings["loops"]:
        own = having(results, loops=loops)
        for (place, choice), (number, use) in product(enumerate(mazes.choices_of(settings)), enumerate(uses)):
            yield {"loops": loops, **choice, **use}, _found(own, place, number)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The learning curves of the first tasks at the default."""
    own = having(results, loops=settings["loops"][0])
    return [
        {"curve_of": way, **block_curve(np.array(blocks), settings["episodes"])}
        for way in WAYS
        if (blocks := [blocks for result in own for blocks in result[f"curve_{way}"]])
    ]


LABELS = {"plain": "without advice", "advised": "with advice"}


@panels(6.4, 3.6)
def draw(result: Mapping, axes: Axes) -> None:
    """Figure of claim C3.16: the thesis's Figure 3.22, rewards of Q-learning with advice and without.

    The figure from the result: tasks of the first mazes, with one standard deviation.
    """
    series = {LABELS[row["curve_of"]]: row for row in result["rows"]}
    looks = {label: {"color": ADVICE_COLOURS[label]} for label in series}
    draw_curves(axes, None, series, looks=looks, xlabel="episode", ylabel="reward of an episode")
    axes.set(ylim=(0, 1000), xlim=(0, result["settings"]["episodes"]))
