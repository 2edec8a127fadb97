"""A life of driven jobs: what the robot learns of its building, and the same jobs planned on the map alone."""

from threading import Event
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.life.loop import Stopped
from lifelore.agent.live.driven.drive_job import DrivenJob, drive_job
from lifelore.agent.live.driven.robot_clock import RobotClock, clock_text, job_start, list_day, next_start
from lifelore.agent.live.driven.route import cheapest_route, moves_along
from lifelore.agent.live.goals.own_places import OwnGoal
from lifelore.agent.live.grid_life import DRIVEN, GridLife, LivedByAll, Result
from lifelore.agent.live.lore import Lore
from lifelore.agent.live.summary import summarise_drives
from lifelore.agent.travel.travel import Travel
from lifelore.core.streams import stream
from lifelore.domains.buildings.busy_building import SPEED, BusyBuilding, Drive
from lifelore.domains.grids.grid_world import GridWorld

MEMORY, MAP_ONLY = "lore", "map only"
"""Names of the agent that remembers the building, and of the agent that plans on the map and remembers nothing."""


class DrivenLife(GridLife):
    """A life of jobs with known goals, and what is known of the building."""

    how = DRIVEN

    def __init__(self, *life: Any) -> None:
        super().__init__(*life)
        settings, busy = self.settings, self.settings.in_busy_building
        self._compare = busy if settings.compare is None else settings.compare
        self._busy = BusyBuilding(self.place.world, settings.seed) if busy else None

    def recall(self) -> None:
        """Know what memory holds of the building, and where the robot stands."""
        settings, place, memory = self.settings, self.place, self.memory
        self.lore = Lore.recalled(place.world, settings.alpha0, memory, place.grid)
        self._travel = Travel.recalled(place.world, place.grid, memory)
        self._clock = RobotClock.recalled(place, settings.memory.robot, memory)

    def live_by_all(self, number: int, seq: int, own: OwnGoal | None, stop: Event) -> LivedByAll:
        """Drive to the goal with memory, and again on the map alone, from one start at one clock."""
        assert own is not None, "driven tasks have goals"
        if stop.is_set():
            raise Stopped
        clock, start = self._begin(own), self._start(number, seq, own.state)
        first = self._drive(number, start, own.state, clock, self._travel)
        results: dict[str, Result] = {MEMORY: first}
        if self._compare:
            know_nothing = Travel(self.place.world, self.place.grid)
            results[MAP_ONLY] = self._drive(number, start, own.state, clock, know_nothing)
        self._walked(first)
        stands = int(first.legs[-1][-1]) if first.legs else start
        self._clock = self._clock.at(clock + first.seconds, stands)
        records = [self.lore.model_news(), *self._travel.news(), self._clock.record(self.place)]
        report = {
            "clock": clock_text(clock),
            "start": self.place.world.cells[start].tolist(),
            "map_metres": round(self._map_metres(start, own.state), 3),
        }
        known = {"places": self.lore.known_places}
        return LivedByAll(own.state, results, records, report, known)

    def _begin(self, own: OwnGoal) -> float:
        """When the job starts: at its time, or in turn; not before the robot is free."""
        now, time = self._clock.clock, own.time
        if self.jobs is None or time is None:
            return next_start(now)
        return max(job_start(time, self.jobs.begun(lambda: list_day(now, time))), now)

    def _start(self, number: int, seq: int, goal: int) -> int:
        """The given start, or any place; in a job list, from the second job on, where the robot stands."""
        stands = self._clock.state
        in_list = self.jobs is not None and self.jobs.finished + seq > 0
        if self.places.start is not None and not in_list:
            return self.places.start
        if self.jobs is not None and stands is not None:
            return stands
        others = np.delete(np.arange(self.place.world.n_states), goal)
        return int(stream(self.settings.seed, "task", number, "start").choice(others))

    def _drive(self, number: int, start: int, goal: int, clock: float, travel: Travel) -> DrivenJob:
        """Drive a job; the noise of the building is the same for both agents."""
        world, noise = self.place.world, stream(self.settings.seed, "task", number, "drive")

        def building(way: NDArray[np.int64], clock: float) -> Drive:
            return quiet_building(way, clock, world) if self._busy is None else self._busy.drive(way, clock, noise)

        def observe(*moves: NDArray) -> None:
            # Simulated times of a quiet building would count beside those that the robot logged.
            if self._busy is not None:
                travel.observe(*moves)

        return drive_job(world, start, goal, clock, lambda now: travel.costs(now).cost, building, observe)

    def _map_metres(self, start: int, goal: int) -> float:
        """Length of the shortest route on the map; 0 where there is none."""
        world = self.place.world
        route = cheapest_route(world, start, goal, np.where(world.neighbour >= 0, 1.0, np.inf))
        return 0.0 if route is None else float(route.lengths.sum()) * world.frame.cell

    def _walked(self, drive: DrivenJob) -> None:
        """Remember the moves that were made, for ways over known places."""
        world, model = self.place.world, self.lore.model
        for leg in drive.legs:
            model.target[leg[:-1], moves_along(world, leg)] = leg[1:]
            model.percept[leg] = world.percepts[leg]

    def summary(self) -> dict:
        """Means of each agent over thirds of the jobs, and memory compared with the map alone."""
        return summarise_drives(self.finished)


def quiet_building(way: NDArray[np.int64], clock: float, world: GridWorld) -> Drive:
    """A building in which every move is made at full speed, and none is refused."""
    seconds = np.full(len(way) - 1, world.frame.cell / SPEED)
    ends = clock + seconds.cumsum()
    return Drive(way[:-1], moves_along(world, way), ends - seconds, seconds, float(ends[-1]))
