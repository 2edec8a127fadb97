"""C4.7: policy reuse beside bandits and Bayesian optimisation on the same surveillance tasks.

What each method was given stands in `surveillance_peers.GIVEN` and beside the figure: the peers know what the
thesis gave them, and tuned peers more, for their settings are those of least regret on these very tasks.
Nothing of policy reuse is tuned. Headline: models learnt from `samples` deployments a pair, with unseen tasks
among those met.

The thesis has 50 tasks; here are six times as many, over layouts, distances and noises.

Thesis: §4.6.4, Figure 4.11.
"""

from collections.abc import Mapping

from lifelore.experiments.chapter4.c4_05_selection_rules.run import check, reserve_cells
from lifelore.experiments.chapter4.surveillance_peers import GP_PEERS, PEERS
from lifelore.experiments.chapter4.surveillance_runs import run_method

__all__ = ["cells", "check", "run_cell"]
REUSE = ("EI", "EI, printed", "IDS", "sampling")
CASES_SHOWN = ("headline", "exact")
IN_GRID = ("EI", "UCB1", "UCB1, tuned", *GP_PEERS, "interval estimation", "eps-greedy on means")


def cells(settings: Mapping) -> list[dict]:
    """Every method in the default reserve, learnt and exact; in the other reserves the ones the thesis names."""
    return reserve_cells(settings, CASES_SHOWN, (*REUSE, *PEERS), IN_GRID)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One method on all its tasks."""
    return run_method(settings, cell, seed)
