"""C2.5: relations stay right when most of the points are thrown away.

Asked of the thesis's displacements read two ways and of our default, all on the same scenes, whole and spoilt;
what is lost is a paired difference, and scenes are resampled. *Robust* is at most 3 points lost. Pairs whose gap
lies within 5 mm of the limit of *adjacent* are left out in simulation: noise decides them. Further panels: depth
noise, labels swapped at the border, masks grown over it. Thesis: §2.4.1.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.domains.tabletop.depth_camera import CAMERAS
from lifelore.experiments.chapter2.spoilt_scenes import WAYS, run_cell
from lifelore.experiments.chapter2.spoilt_scenes import scene_cells as cells

__all__ = ["cells", "check", "run_cell"]


def check(settings: Mapping) -> None:
    if settings["scenes"] < 1 or settings["lessons"] < 1:
        raise InputError(f"scenes and lessons must be at least 1, got {settings['scenes']}, {settings['lessons']}")
    if settings["camera"] not in CAMERAS:
        raise InputError(f"camera must be one of {', '.join(CAMERAS)}, got '{settings['camera']}'")
    if set(settings["levels"]) - set(WAYS) or not settings["levels"]:
        raise InputError(f"levels must name some of {', '.join(WAYS)}, got {', '.join(settings['levels'])}")
