"""The calendar of driven jobs: when and where a robot starts its next job.

The calendar is simulated. It begins on Monday 2024-01-01, and goes on from run to run. A record of kind
"robot_clock" holds the clock of a robot in a building in slot 0 (seconds since 1970), and in slot 1 the cell in
which it stands, in the grid of the building's first map; the newest counts. The place is not known in a life with
cells of another size.
"""

import math
from dataclasses import dataclass, replace
from datetime import UTC, datetime, time

import numpy as np

from lifelore.agent.live.buildings.recognition import Place
from lifelore.agent.live.goals.job_list import parsed_time
from lifelore.core.protocols import Record
from lifelore.domains.grids.cell_numbers import cells_in_building, states_in_building
from lifelore.memory import Memory

KIND, VERSION = "robot_clock", 1
BEGIN = datetime(2024, 1, 1, tzinfo=UTC).timestamp()
DAY, WORKING_DAYS = 86_400.0, 5
FIRST_HOUR, LAST_HOUR = 8.0, 18.0
"""Hours between which jobs without times start."""
EVERY = 1800.0
"""Seconds between the starts of two jobs without times."""


@dataclass(frozen=True)
class RobotClock:
    """Clock and place of a robot.

    key : of the building and the robot
    clock : seconds since 1970
    state : in which the robot stands; None if it is not known, or no place of the present map
    """

    key: str
    clock: float = BEGIN
    state: int | None = None

    @classmethod
    def recalled(cls, place: Place, robot: str, memory: Memory) -> "RobotClock":
        """What memory holds; a robot that is new in a building starts at the latest clock of the others."""
        building = place.grid.building or place.grid.frame
        clocks = [about["clock"] for _, _, about in memory.keys(KIND) if about["building"] == building]
        new = cls(f"{building}/{robot}", max(clocks, default=BEGIN))
        record = memory.recall(KIND, new.key, VERSION)
        if record is None:
            return new
        state, cell = -1, place.world.frame.cell
        if record.about.get("cell", cell) == cell:
            state = int(states_in_building(place.world, record.values[1:2], place.grid.corner)[0])
        return replace(new, clock=float(record.values[0]), state=state if state >= 0 else None)

    def at(self, clock: float, state: int) -> "RobotClock":
        """The robot at another clock, to the full second, and in another state."""
        return replace(self, clock=float(math.ceil(clock)), state=state)

    def record(self, place: Place) -> Record:
        """The record by which memory knows clock and place of the robot from then on."""
        cell = cells_in_building(place.world, place.grid.corner)[self.state]
        building, robot = self.key.split("/", 1)
        about = {"building": building, "robot": robot, "clock": int(self.clock), "cell": place.world.frame.cell}
        return Record(KIND, self.key, VERSION, "newest", np.arange(2), np.array([int(self.clock), cell]), about)


def next_start(clock: float) -> float:
    """When a job without a time starts: at the next full half hour of working time, at or after `clock`."""
    start = math.ceil(clock / EVERY) * EVERY
    while not _is_working_day(start) or not FIRST_HOUR <= (start - BEGIN) % DAY / 3600 < LAST_HOUR:
        start += EVERY
    return start


def list_day(clock: float, first_time: str) -> float:
    """Midnight of the first working day on which a job list can start at the time of its first job."""
    day = BEGIN + (clock - BEGIN) // DAY * DAY
    dated = isinstance(parsed_time(first_time), datetime)
    while not _is_working_day(day) or (job_start(first_time, day) < clock and not dated):
        day += DAY
    return day


def job_start(text: str, day: float) -> float:
    """The clock that a time of a job list means: a number of seconds or HH:MM on `day`, or a date in ISO 8601."""
    when = parsed_time(text)
    if isinstance(when, datetime):
        return (when if when.tzinfo else when.replace(tzinfo=UTC)).timestamp()
    if isinstance(when, time):
        return day + 3600.0 * when.hour + 60.0 * when.minute + when.second
    return day + when


def clock_text(clock: float) -> str:
    """The clock as ISO 8601, to the second."""
    return datetime.fromtimestamp(round(clock), UTC).strftime("%Y-%m-%dT%H:%M:%S")


def _is_working_day(clock: float) -> bool:
    return (clock - BEGIN) // DAY % 7 < WORKING_DAYS
