"""C4.7: policy reuse, bandits and Bayesian optimisation on the same tasks. Thesis: §4.6.4, Figure 4.11.

The settings of tuned peers are those of least regret on these very tasks; nothing of policy reuse is tuned.
"""

from collections.abc import Mapping

from reproduction.chapter4.surveillance.peers import GP_PEERS, PEERS
from reproduction.chapter4.surveillance.runs import check_reserves as check
from reproduction.chapter4.surveillance.runs import reserve_cells
from reproduction.chapter4.surveillance.runs import run_method as run_cell

__all__ = ["cells", "check", "run_cell"]
REUSE = ("EI", "EI, printed", "IDS", "sampling")
DOUBTING = ("EI", "IDS", "sampling")
"""Rules that also run with a belief over types and the parameters of their models."""
CASES_SHOWN = ("headline", "exact", "learnt")
IN_GRID = ("EI", "UCB1", "UCB1, tuned", *GP_PEERS, "interval estimation", "eps-greedy on means")


def cells(settings: Mapping) -> list[dict]:
    """Every method in the default reserve, learnt and exact; in the other reserves the methods of the thesis.

    Rules that doubt their models run in the default reserve, with every second task unseen.
    """
    doubting = reserve_cells(settings, ["uncertain, with unseen"], DOUBTING, ())
    return [*reserve_cells(settings, CASES_SHOWN, (*REUSE, *PEERS), IN_GRID), *doubting]
