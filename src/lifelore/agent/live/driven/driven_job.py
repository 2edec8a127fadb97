"""`DrivenJob`: the result of a job that was driven."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass
class DrivenJob:
    """The drive to a known goal.

    reached : whether the robot arrived; otherwise no way was left
    metres : driven, along moves and diagonal steps
    seconds : from the start to the arrival, or until no way was left
    refusals : moves that the building refused
    replans : routes that were planned after the first one
    moves : number of moves made
    legs : the states passed, a list for each route, each from its start on
    """

    reached: bool
    metres: float
    seconds: float
    refusals: int
    replans: int
    moves: int
    legs: list[NDArray[np.int64]] = field(repr=False)

    def paths(self) -> list[NDArray[np.int32]]:
        """All states passed, as one path; none if the robot stood at the goal."""
        if not self.legs:
            return []
        return [np.concatenate([leg[:-1] for leg in self.legs] + [self.legs[-1][-1:]]).astype(np.int32)]

    def drop_arrays(self) -> None:
        """Drop the states passed."""
        self.legs = []

    def episodes(self) -> dict[str, NDArray]:
        """A drive has no episodes."""
        return {}

    def to_dict(self) -> dict:
        """The numbers as JSON data."""
        return {
            "reached": self.reached,
            "metres": round(self.metres, 3),
            "seconds": round(self.seconds, 3),
            "refusals": self.refusals,
            "replans": self.replans,
        }
