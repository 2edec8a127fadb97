"""C2.2: the two components of a label told for a split of 95 and 33 pictures, and how the neighbours agree.

Relationships are counted as the thesis counts them, one a displacement (116 and 49 of 128 pictures), each with its
picture's label. One random split has an error of six points either way, so that 200 are drawn of every data set.
Thesis: §2.4.1.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.experiments.chapter2.c2_01_nearest_displacements.run import check_pairs
from lifelore.experiments.chapter2.tabletop_pairs import pair_cells as cells
from lifelore.experiments.chapter2.tabletop_pairs import run_cell

__all__ = ["cells", "check", "run_cell"]


def check(settings: Mapping) -> None:
    check_pairs(settings)
    if not 1 <= settings["test"] < settings["pairs"] or settings["splits"] < 1:
        raise InputError(
            f"test must lie in [1, {settings['pairs'] - 1}] and splits be at least 1, "
            f"got {settings['test']} and {settings['splits']}"
        )
