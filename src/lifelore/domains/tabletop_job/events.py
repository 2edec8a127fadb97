"""What an action did to the tray, read from the places of all objects before, during and after it."""

from dataclasses import dataclass

import numpy as np

from lifelore.domains.tabletop_job.gripper_tray import EDGE, GripperTray
from lifelore.domains.tabletop_job.skills import Outcome

SPILL_FALL = 0.02
"""Metres by which an object's middle falls from its highest place when it is spilled."""
KNOCK_MOVE = 0.02
"""Metres over the table by which an object that is not spilled moves when it is knocked."""


@dataclass(frozen=True)
class Events:
    """What one action did.

    Parameters
    ----------
    seconds : float
        Of the arm's motion.
    reached : bool
        Whether the fingers got around the object; a push always does.
    slipped : bool
        Whether the held object slipped out of the fingers.
    handed : int or None
        Object handed over.
    put_aside : int or None
        Object set down on a free place.
    spilled, knocked : tuple of int
        Objects that fell, or slipped and fell, and objects that were moved without falling.
    lost : tuple of int
        Objects that are off the table now; all of them are spilled, too.
    """

    seconds: float
    reached: bool = True
    slipped: bool = False
    handed: int | None = None
    put_aside: int | None = None
    spilled: tuple[int, ...] = ()
    knocked: tuple[int, ...] = ()
    lost: tuple[int, ...] = ()


class Witness:
    """Notes where everything is; `events` compares with it, and takes lost objects off the table.

    Parameters
    ----------
    tray : GripperTray
    moved : int
        The object that the action moves on purpose: it may be moved and set down, but not fall out of the fingers.
    """

    def __init__(self, tray: GripperTray, moved: int) -> None:
        self._tray, self._moved = tray, moved
        self._before = tray.centres
        self._here = tray.here
        tray.highest = self._before[:, 2].copy()

    def events(self, outcome: Outcome, pushed: bool = False, put_aside: bool = False) -> Events:
        """The events since."""
        tray = self._tray
        now, held = tray.centres, None if tray.grip is None else tray.grip.object
        others = [k for k in self._here if k not in (outcome.handed, held)]
        lost = [k for k in others if np.hypot(*now[k, :2]) > EDGE]
        fallen = [k for k in others if tray.highest[k] - now[k, 2] > SPILL_FALL]
        spilled = {*lost, *fallen}
        down = put_aside and not outcome.slipped
        if down:
            spilled.discard(self._moved)
        knocked = [
            k
            for k in others
            if k not in spilled
            and not (k == self._moved and (pushed or down))
            and np.linalg.norm(now[k, :2] - self._before[k, :2]) > KNOCK_MOVE
        ]
        for k in lost:
            tray.remove(k)
        return Events(
            outcome.seconds,
            outcome.reached,
            outcome.slipped,
            outcome.handed,
            self._moved if down else None,
            tuple(sorted(spilled)),
            tuple(knocked),
            tuple(lost),
        )
