"""Registration of two views of one tabletop: search, refinement, and whether the answer is sure."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.registration.agreement import Agreement, agreement
from lifelore.perception.registration.refinement import refined_motion
from lifelore.perception.registration.start_search import find_starts
from lifelore.perception.registration.tabletop_view import TabletopView

LEAST_EVIDENCE = 0.4
"""Least `Agreement.evidence`: less is an overlap too small to tell."""
LEAST_SHARE = 0.96
"""Least `Agreement.share`; less means that something moved, or that the motion is wrong."""
RIVAL = 0.7
"""Greatest evidence of another motion, as a share of the best motion's: objects that look alike from two sides."""
APART_TURN, APART_SHIFT = np.radians(5.0), 0.02
"""Motions that differ more, by turn or at the middle of the objects, are different answers."""


@dataclass(frozen=True, eq=False)
class Registration:
    """A motion of one view onto another, and how sure it is.

    Parameters
    ----------
    motion : (4, 4) float64
        From the frame of the source's cloud to the frame of the target's cloud.
    agreement : Agreement
    rival : float
        Evidence of the best other motion; 0 without.
    moved : (3,) float64, optional
        Where something moved between the views, in the frame of the target's cloud, see `Agreement`.
    """

    motion: NDArray[np.float64]
    agreement: Agreement
    rival: float
    moved: NDArray[np.float64] | None = None

    @property
    def doubt(self) -> str | None:
        """Why the motion is not sure, in words; None where it is."""
        found = self.agreement
        place = "" if self.moved is None else ", ".join(f"{x:.2f}" for x in self.moved)
        if found.evidence < LEAST_EVIDENCE and found.share >= LEAST_SHARE:
            return (
                f"they show too little of the same objects (evidence {max(found.evidence, 0.0):.2f}, at least"
                f" {LEAST_EVIDENCE} is needed)"
            )
        if found.share < LEAST_SHARE:
            return (
                f"they contradict each other at their best ({found.share:.1%} of what both show agrees, at least"
                f" {LEAST_SHARE:.0%} must){f', most at {place} m in the first' if place else ''}"
            )
        if place:
            return f"something moved between them, at {place} m in the frame of the first"
        if self.rival > RIVAL * found.evidence:
            return "their objects fit in more than one way"
        return None


def registered_pair(target: TabletopView, source: TabletopView) -> Registration | None:
    """The best motion of `source` onto `target`; None where no start leads anywhere."""
    ends = [refined_motion(target, source, start.motion) for start in find_starts(target, source)]
    judged = [(agreement(target, source, motion), motion) for motion in ends if motion is not None]
    if not judged:
        return None
    best, motion = max(judged, key=lambda end: end[0].evidence)
    rival = max((other.evidence for other, end in judged if is_apart(end, motion)), default=0.0)
    whole = np.linalg.inv(target.from_view) @ motion @ source.from_view
    moved = None if best.moved is None else (best.moved - target.from_view[:3, 3]) @ target.from_view[:3, :3]
    return Registration(whole, best, max(rival, 0.0), moved)


def is_apart(motion: NDArray[np.float64], other: NDArray[np.float64]) -> bool:
    """Whether two motions (4, 4) differ by more than `APART_TURN` or `APART_SHIFT` at their frame's origin."""
    turn = motion[:3, :3].T @ other[:3, :3]
    cosine = (np.trace(turn) - 1) / 2
    return bool(
        np.arccos(np.clip(cosine, -1.0, 1.0)) > APART_TURN
        or np.linalg.norm(motion[:3, 3] - other[:3, 3]) > APART_SHIFT
    )
