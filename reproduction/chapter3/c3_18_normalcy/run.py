"""C3.18: P(M₁ | H), the probability that an explorer acts as the experts do, with advice and without.

The rise is partly by construction: an advised step is drawn from θ, which is M₁. It is therefore measured three
times: with all steps in H, as the thesis does; with the agent's own steps alone in H; and with all steps in H, but
only at steps without advice. The last selects what it measures: no advice is given where P(M₁ | H) is high.
Thesis: §3.7.2.3, Figure 3.21.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.action.advice.advised_walk import Walk
from lifelore.action.advice.advisor import Advisor
from lifelore.core.errors import InputError
from lifelore.domains.advice.explorers import EXPLORERS
from reproduction.chapter3.advice import mazes
from reproduction.chapter3.advice.mazes import maze_cells as cells

__all__ = ["cells", "check", "run_cell"]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze: P(M₁ | H) of each explorer, alone and advised by the thesis's advisor of each kind of experts."""
    maze, found = mazes.maze_of(settings, cell, seed), []
    n_blocks, length = settings["blocks"], settings["max_steps"] // settings["blocks"]
    for experts in settings["experts"]:
        advisor = mazes.thesis_advisor(settings, mazes.goal_models_of(settings, maze, experts))
        for agent in EXPLORERS:
            policies = mazes.policies_of(settings, maze, agent)
            alone, advised = (mazes.walks_of(settings, maze, policies, advisor, heeds) for heeds in (False, True))
            found.append({
                "experts": experts,
                "agent": agent,
                "alone": [float(w.p_normal.mean()) for w in alone],
                "told": [float(w.p_normal.mean()) for w in advised],
                "own": [own_normalcy(advisor, w) for w in advised],
                "unadvised": [unadvised_normalcy(w) for w in advised],
                "advised_share": [float(w.advised.mean()) for w in advised],
                "curve_alone": block_curve(alone, n_blocks, length),
                "curve_told": block_curve(advised, n_blocks, length),
            })  # fmt: skip
    return {**cell, "explorers": found}


def own_normalcy(advisor: Advisor, walked: Walk) -> float:
    """Mean P(M₁ | H) of a walk when H holds only the steps that the agent chose itself."""
    return float(advisor.assess(walked.states, np.where(walked.advised, -1, walked.actions)).p_normal.mean())


def unadvised_normalcy(walked: Walk) -> float | None:
    """Mean P(M₁ | H), advised steps in H, over the steps that were not advised; None where all were."""
    kept = walked.p_normal[~walked.advised]
    return float(kept.mean()) if kept.size else None


def block_curve(walks: Sequence[Walk], n_blocks: int, length: int) -> dict:
    """By blocks of steps: the sum of P(M₁ | H), the steps still walked, and the walks at their goal by then."""
    p, n, reached = np.zeros(n_blocks), np.zeros(n_blocks, int), np.zeros(n_blocks, int)
    for walked in walks:
        block = np.arange(len(walked.states)) // length
        p += np.bincount(block, walked.p_normal, n_blocks)
        n += np.bincount(block, minlength=n_blocks)
        if walked.reached:
            reached[block[-1] :] += 1
    return {"p": np.round(p, 6).tolist(), "n": n.tolist(), "reached": reached.tolist()}


def check(settings: Mapping) -> None:
    if settings["max_steps"] % settings["blocks"]:
        raise InputError(f"blocks must divide max_steps ({settings['max_steps']}), got {settings['blocks']}")
