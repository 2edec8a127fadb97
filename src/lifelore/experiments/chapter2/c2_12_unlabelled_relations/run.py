"""C2.12: relations found without labels, by X-means on displacements between contact points.

The thesis proposes it, does not try it, and fears that *on* and *adjacent* may blur where one thing rests against
another at an angle. Each data set is clustered by itself, from several random starts whose numbers are averaged;
intervals are over data sets. Real scenes stand beside, as one data set. Thesis: §2.3.5.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.experiments.chapter2.c2_01_nearest_displacements.run import check_pairs
from lifelore.experiments.chapter2.tabletop_pairs import pair_cells as cells
from lifelore.experiments.chapter2.tabletop_pairs import run_cell

__all__ = ["cells", "check", "run_cell"]


def check(settings: Mapping) -> None:
    check_pairs(settings)
    if settings["starts"] < 1:
        raise InputError(f"starts must be at least 1, got {settings['starts']}")
