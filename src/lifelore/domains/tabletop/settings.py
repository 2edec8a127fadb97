"""`TabletopSettings`: what scenes to draw; `TabletopScene`: what comes of it."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.relations import CORE_RELATIONS, PairLabel
from lifelore.domains.tabletop.depth_camera import CAMERAS
from lifelore.domains.tabletop.pose import Pose
from lifelore.domains.tabletop.shapes import Shape
from lifelore.domains.tabletop.truth import Gap


@dataclass(frozen=True)
class TabletopSettings:
    """What scenes to draw.

    Parameters
    ----------
    n_objects : (int, int)
        Fewest and most objects of a scene, at least 1; a named arrangement has its own number.
    arrangement : str
        A key of `arrangements.ARRANGEMENTS`.
    mix : mapping of str to float, optional
        Wanted shares of *on*, *adjacent*, *both* and *none* among the scenes of the arrangement ``"pair"``, by
        truth; any positive scale.
    camera : str
        ``"kinect"`` or ``"stereo"``.
    shapes : str
        ``"training"``, ``"held-out"`` (no kind in common) or ``"all"``.

    Raises
    ------
    InputError
        A value breaks its rule.
    """

    n_objects: tuple[int, int] = (2, 7)
    arrangement: str = "mixed"
    mix: Mapping[str, float] | None = None
    camera: str = "kinect"
    shapes: str = "training"

    def __post_init__(self) -> None:
        low, high = self.n_objects
        if not 1 <= low <= high <= 20:
            raise InputError(f"n_objects must be fewest and most, 1 to 20, got {low} and {high}")
        if self.camera not in CAMERAS:
            raise InputError(f"camera must be one of {', '.join(CAMERAS)}, got '{self.camera}'")
        if self.mix is not None:
            if self.arrangement != "pair":
                raise InputError(f"mix applies to arrangement pair, got '{self.arrangement}'; leave it out")
            _check_mix(self.mix)


def _check_mix(mix: Mapping[str, float]) -> None:
    for label, share in mix.items():
        if label not in CORE_RELATIONS:
            raise InputError(f"mix names {', '.join(CORE_RELATIONS)}, got '{label}'")
        if not 0 <= share < np.inf:
            raise InputError(f"shares of mix must be finite and not negative, got {label}={share}")
    if not sum(mix.values()) > 0:
        raise InputError("mix must ask for at least one relation: give one a share above 0")


def wanted_relation(number: int, mix: Mapping[str, float]) -> str:
    """The relation of pair `number` such that the first n pairs are as near to the mix as whole numbers allow.

    Examples
    --------
    >>> [wanted_relation(i, {"on": 2, "adjacent": 1}) for i in range(6)]
    ['on', 'adjacent', 'on', 'on', 'adjacent', 'on']
    """
    shares = np.array([float(mix.get(relation, 0.0)) for relation in CORE_RELATIONS])
    shares = shares / shares.sum()
    counts, chosen = np.zeros(len(shares)), 0
    for n in range(number + 1):
        chosen = int(np.argmax(shares * (n + 1) - counts))
        counts[chosen] += 1
    return CORE_RELATIONS[chosen]


@dataclass(frozen=True, eq=False)
class TabletopScene:
    """A settled scene: its cloud in the table's frame, and what is true of it.

    `truth` holds every near pair of objects and every object with the table (label 1); `gaps` the visible and
    true distance of the near pairs; `shapes` and `poses` object by object, whose labels are 2, 3, …; `view` the
    camera's pose (x right, y down, z forward); `clean` the cloud's points without noise; `attempts` the number of
    draws.
    """

    name: str
    cloud: LabelledCloud
    truth: tuple[PairLabel, ...]
    gaps: tuple[Gap, ...]
    shapes: tuple[Shape, ...]
    poses: tuple[Pose, ...]
    view: Pose
    clean: NDArray[np.float64]
    attempts: int = 1
