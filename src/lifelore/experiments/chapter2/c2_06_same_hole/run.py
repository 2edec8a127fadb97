"""C2.6: the hole between two things, found as a cycle of their contact point networks.

An L-block carries one of two hinged blocks, or a different thing, and in both scenes the loop through both
networks and the contact edges between them is found. A cycle alone is also what one long contact leaves that came
out as two contact points, so a loop counts as a hole only if it opens (`perception.holes`); the share of scenes
with any cycle stands beside it. What is true is told by sticks pushed through the true shapes (`passage`). The
things' contacts with the ground take no part. Real scenes carry no truth about holes; how many show one is only
counted. Thesis: §2.4.2, Figure 2.6.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.experiments.chapter2.c2_06_same_hole.hole_scenes import ARRANGEMENTS, LOT, run_cell
from lifelore.experiments.chapter2.real_scenes import real_scenes, real_scenes_folder

__all__ = ["cells", "check", "run_cell"]


def check(settings: Mapping) -> None:
    if settings["scenes"] < 1:
        raise InputError(f"scenes must be at least 1, got {settings['scenes']}")


def cells(settings: Mapping) -> list[dict]:
    """Scenes in lots, by kind; then the real scenes, where asked for and there."""
    lots = [{"kind": kind, "first": k} for kind in ARRANGEMENTS for k in range(0, settings["scenes"], LOT)]
    if not settings["real"] or real_scenes_folder() is None:
        return lots
    return lots + [{"kind": "real", "scene": scene.name} for scene in real_scenes()]
