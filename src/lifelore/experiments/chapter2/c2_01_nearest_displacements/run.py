"""C2.1: the relation of a held-out pair from the nearest displacements between contact points.

The thesis's own method, leave one picture out, k = 4, union over displacements, with A and B given as its pictures
had them and with the direction inferred; beside it our default and what others would do, on simulated pairs in the
thesis's class mix and on real scenes. Kernel, what happens to weak contacts, and how votes weigh are not stated:
they are crossed. Thesis: §2.4.1, Figure 2.5.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.domains.tabletop.depth_camera import CAMERAS
from lifelore.experiments.chapter2.tabletop_pairs import pair_cells as cells
from lifelore.experiments.chapter2.tabletop_pairs import run_cell

__all__ = ["cells", "check", "run_cell"]


def check_pairs(settings: Mapping) -> None:
    """Raises InputError for sizes that no lot of pairs can have; shared by the claims that rest on pairs."""
    for key, least in (("data_sets", 1), ("pairs", 4)):
        if settings[key] < least:
            raise InputError(f"{key} must be at least {least}, got {settings[key]}")
    if settings["camera"] not in CAMERAS:
        raise InputError(f"camera must be one of {', '.join(CAMERAS)}, got '{settings['camera']}'")


def check(settings: Mapping) -> None:
    check_pairs(settings)
    if settings["folds"] < 2 or not settings["omega"] > 0:
        raise InputError(f"need folds >= 2 and omega > 0, got {settings['folds']} and {settings['omega']}")
