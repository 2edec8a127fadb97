"""A py_trees behaviour that drives by the way that memory knows, and tells memory how the drive went.

initialise    ask memory for the way, and hand its poses to the driver
update        note where the robot is, until the driver says how the drive ended
terminate     memory learns the seconds of each move, and where the robot was refused

Needs Lifelore and py_trees. Untested on a robot.
"""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from lifelore.agent.learn_from.learn_from import learn_from
from lifelore.agent.learn_from.run_log import FAILED, GOAL, NOTHING, Run
from lifelore.agent.live.goals.destinations import destination_from_text
from lifelore.agent.way import way
from lifelore.core.errors import LifeloreError
from lifelore.domains.buildings.occupancy_map import read_occupancy_map

SPACING = 0.05
"""Metres between two poses of a way, at most."""


class Driver(Protocol):
    """What the behaviour needs of a robot, such as a client of nav2's action FollowPath."""

    def follow(self, poses: NDArray[np.float64]) -> None:
        """Begin to follow poses, (n, 3) x, y (metres of the map's frame) and heading (radians)."""
        ...

    def pose(self) -> tuple[float, float, float, float]:
        """Seconds since 1970, x, y and heading of the robot now."""
        ...

    def outcome(self) -> str | None:
        """How the drive ended: "goal", "bump" (something stands ahead) or "failed"; None while it goes on."""
        ...

    def stop(self) -> None:
        """Stop the robot: the tree gave the drive up."""
        ...


class DriveByMemory(Behaviour):
    """Drive to a place by the way that memory knows.

    It fails where memory does not know the building or the drive ends elsewhere; `feedback_message` then says why.

    Parameters
    ----------
    name : str
    driver : Driver
    start, goal : str
        Names that memory knows, or "X,Y" in metres of the map's frame; without a `start`, where the robot is.
    map : str
        YAML of the map.
    memory : str, optional
        SQLite file or URL; None: the user's own.
    robot : str
        Name of the robot in memory.
    """

    def __init__(
        self, name: str, driver: Driver, goal: str, map: str, memory: str | None = None,
        start: str | None = None, robot: str = "robot",
    ) -> None:  # fmt: skip
        super().__init__(name)
        self._driver, self._start, self._goal = driver, start, goal
        self._map, self._memory, self._robot = map, memory, robot
        self._drive: list[tuple[float, float, float, float]] = []

    def setup(self, **kwargs: object) -> None:
        """Read the map, so that a mistake in its name shows before the tree ticks."""
        read_occupancy_map(self._map)

    def initialise(self) -> None:
        """Ask memory for the way and begin to follow it."""
        self._drive, self._outcome, self.feedback_message = [], None, ""
        try:
            ends = destination_from_text("start", self._from()), destination_from_text("goal", self._goal)
            found = way(*ends, map=self._map, memory=self._memory, spacing=SPACING)
        except LifeloreError as error:
            self._outcome, self.feedback_message = FAILED, str(error)
            return
        self._driver.follow(found.poses)

    def _from(self) -> str:
        _, x, y, _ = self._driver.pose()
        return self._start or f"{x},{y}"

    def update(self) -> Status:
        """Note the pose and the outcome."""
        if self._outcome is not None:
            return Status.FAILURE
        self._drive.append(self._driver.pose())
        self._outcome = self._driver.outcome()
        if self._outcome is None:
            return Status.RUNNING
        self.feedback_message = "" if self._outcome == GOAL else f"the drive ended with: {self._outcome}"
        return Status.SUCCESS if self._outcome == GOAL else Status.FAILURE

    def terminate(self, new_status: Status) -> None:
        """Memory learns from the drive, also if the tree gave it up."""
        drive, self._drive = self._drive, []
        if drive and self._outcome is None:
            self._driver.stop()
        if len(drive) < 2:
            return
        time, x, y, heading = np.array(drive).T
        outcomes = [NOTHING] * (len(drive) - 1) + [self._outcome or FAILED]
        run = Run(self.name, time, np.column_stack([x, y]), heading, outcomes)
        try:
            learn_from([run], map=self._map, memory=self._memory, robot=self._robot, source=self.name)
        except LifeloreError as error:
            self.feedback_message = f"memory learnt nothing from the drive: {error}"
