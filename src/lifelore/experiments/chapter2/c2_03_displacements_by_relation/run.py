"""C2.3: where displacements between contact points lie: a cluster for *on*, a band for *adjacent*, left and right.

A displacement is d = χ_A - χ_B (§2.3.5), x to the camera's right, y up. The thesis's plot has no unit, so all is
asked in fractions of where its *on* cluster lies; and its *on* cluster lies at negative y, so the side is asked as
"the same", not as "down". Every displacement of a pair has the pair's label, as there. Thesis: §2.4.1, Figure 2.4.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.experiments.chapter2.c2_01_nearest_displacements.run import check_pairs
from lifelore.experiments.chapter2.tabletop_pairs import pair_cells as cells
from lifelore.experiments.chapter2.tabletop_pairs import run_cell

__all__ = ["cells", "check", "run_cell"]


def check(settings: Mapping) -> None:
    check_pairs(settings)
    if settings["resamples"] < 2 or not settings["omega"] > 0:
        raise InputError(f"need resamples >= 2 and omega > 0, got {settings['resamples']} and {settings['omega']}")
