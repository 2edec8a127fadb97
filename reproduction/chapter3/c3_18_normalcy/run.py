"""C3.18: P(M₁ | H), the probability that an explorer acts as the experts do, with advice and without.

The rise is partly by construction: an advised step is drawn from θ, which is M₁. It is therefore also measured
with the agent's own steps alone in H. Thesis: §3.7.2.3, Figure 3.21.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from lifelore.action.advice.advisor import Advisor
from lifelore.core.metrics import Estimate
from lifelore.domains.advice.explorers import EXPLORERS
from lifelore.figures.style import INK, Axes
from reproduction.chapter3.advice import mazes
from reproduction.chapter3.advice.advised_walk import Walk
from reproduction.chapter3.advice.mazes import AGENT_COLOURS, EXPLORER_WORDS
from reproduction.engine.records import having
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

cells = mazes.maze_cells
BLOCKS = 50
"""Points of a drawn curve."""
WAYS = ("alone", "advised")


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze: what advice adds to the mean P(M₁ | H) of each explorer, by choice; own steps and curves once."""
    maze, gains, own, curves = mazes.maze_of(settings, cell, seed), [], {}, []
    for choice in mazes.choices_of(settings):
        advisor, of_agents = mazes.thesis_advisor(mazes.goal_models_of(maze, **choice)), {}
        for agent in EXPLORERS:
            policies = mazes.policies_of(settings, maze, agent)
            walks = [mazes.walks_of(settings, maze, policies, advisor, heeds) for heeds in (False, True)]
            alone, advised = (np.array([w.p_normal.mean() for w in of_way]) for of_way in walks)
            of_agents[agent] = float((advised - alone).mean())
            if not gains:
                own[agent] = float(np.mean([own_normalcy(advisor, w) for w in walks[1]] - alone))
                if cell == cells(settings)[0]:
                    curves += [
                        {"curve_of": agent, "way": way, **block_curve(of_way, settings["max_steps"])}
                        for way, of_way in zip(WAYS, walks, strict=True)
                    ]
        gains.append(of_agents)
    return {**cell, "gains": gains, "own": own, "curves": curves}


def own_normalcy(advisor: Advisor, walked: Walk) -> float:
    """Mean P(M₁ | H) of a walk when H holds only the steps that the agent chose itself."""
    return float(advisor.assess(walked.states, np.where(walked.advised, -1, walked.actions)).p_normal.mean())


def block_curve(walks: Sequence[Walk], max_steps: int) -> dict:
    """By even blocks of steps, which end at `x`: mean P(M₁ | H) of walks still under way, and reward so far."""
    length = -(-max_steps // BLOCKS)
    n_blocks = -(-max_steps // length)
    p, n, reached = np.zeros(n_blocks), np.zeros(n_blocks, int), np.zeros(n_blocks)
    for walked in walks:
        block = np.arange(len(walked.states)) // length
        p += np.bincount(block, walked.p_normal, n_blocks)
        n += np.bincount(block, minlength=n_blocks)
        if walked.reached:
            reached[block[-1] :] += 1000 / len(walks)
    return {
        "x": [length * (block + 1) for block in range(n_blocks)],
        "normal": [round(float(a / b), 4) if b else None for a, b in zip(p, n, strict=True)],
        "reward": np.round(reached, 1).tolist(),
    }


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The explorers' mean gain in P(M₁ | H) by own steps, at the default."""
    own = [list(result["own"].values()) for result in having(results, loops=settings["loops"][0])]
    return {"gain_own": mazes.maze_estimate(np.mean(own, axis=1))}


def _gains(results: Sequence[Mapping], place: int) -> dict[str, Estimate]:
    gains = [result["gains"][place] for result in results]
    each = {f"gain_{agent}": mazes.maze_estimate([of_maze[agent] for of_maze in gains]) for agent in EXPLORERS}
    return each | {"gain": mazes.maze_estimate([np.mean(list(of_maze.values())) for of_maze in gains])}


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """Each explorer's gain in P(M₁ | H) by loops, experts and α⁰."""
    for reading, loops, place in mazes.readings_of(settings):
        yield reading, _gains(having(results, loops=loops), place)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The curves of the first maze's walks."""
    return [curve for result in results for curve in result["curves"]]


STYLES = {"alone": "-", "advised": (0, (1.2, 1.2))}
PANELS = {"normal": ("P(M₁ | H) of walks under way", 1.0), "reward": ("mean reward so far, of 1000", 1000.0)}


@panels(9.0, 3.8, 1, 2)
def draw(result: Mapping, *every: Axes) -> None:
    """Figure of claim C3.18: the thesis's Figure 3.21, P(M₁ | H) and rewards of explorers, advised and not.

    The figure from the result: the tasks of one maze; solid alone, dotted advised.
    """
    from matplotlib.lines import Line2D

    for axes, (key, (label, top)) in zip(every, PANELS.items(), strict=True):
        series, looks = {}, {}
        for row in result["rows"]:
            name = f"{row['curve_of']}, {row['way']}"
            series[name] = {"x": row["x"], "mean": np.array(row[key], float)}
            looks[name] = {"color": AGENT_COLOURS[row["curve_of"]], "ls": STYLES[row["way"]], "lw": 1.6}
        draw_curves(axes, None, series, looks=looks, xlabel="step", ylabel=label, legend=False)
        axes.set(ylim=(-0.02 * top, 1.02 * top), xlim=(0, result["settings"]["max_steps"]))
    lines = [Line2D([], [], color=AGENT_COLOURS[agent], lw=2.2) for agent in EXPLORER_WORDS]
    lines += [Line2D([], [], color=INK, lw=1.6, ls=style) for style in STYLES.values()]
    labels = [*EXPLORER_WORDS.values(), "without advice", "with advice"]
    every[0].figure.legend(lines, labels, loc="outside lower left", ncols=6)
