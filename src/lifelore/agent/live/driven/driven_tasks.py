"""The driven jobs of a life: what the robot learns of its building, and the same jobs planned on the map alone."""

from threading import Event

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.life.loop import Stopped
from lifelore.agent.live.buildings.recognition import Place
from lifelore.agent.live.driven.drive_job import DrivenJob, drive_job
from lifelore.agent.live.driven.robot_clock import RobotClock, clock_text, job_start, list_day, next_start
from lifelore.agent.live.driven.route import cheapest_route, moves_along
from lifelore.agent.live.goals.job_progress import JobProgress
from lifelore.agent.live.goals.own_places import OwnGoal, OwnPlaces
from lifelore.agent.live.life_settings import LifeSettings
from lifelore.agent.live.lived_tasks import DRIVEN, LivedByAll
from lifelore.agent.live.lore import Lore, prior_scope
from lifelore.agent.live.summary import summarise_drives
from lifelore.agent.travel.travel import Travel
from lifelore.core.streams import stream
from lifelore.domains.buildings.busy_building import SPEED, BusyBuilding, Drive
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.memory import Memory

MEMORY, MAP_ONLY = "lore", "map only"
"""Names of the agent that remembers the building, and of the agent that plans on the map and remembers nothing."""


class DrivenTasks:
    """Jobs with known goals, and what is known of the building; see `TasksOfLife`.

    Parameters
    ----------
    settings : LifeSettings
    place : Place
    places : OwnPlaces
    memory : Memory
    jobs : JobProgress, optional
        Of a job list.
    """

    how = DRIVEN

    def __init__(
        self, settings: LifeSettings, place: Place, places: OwnPlaces, memory: Memory, jobs: JobProgress | None
    ) -> None:
        compare = settings.in_busy_building if settings.compare is None else settings.compare
        self.names = [MEMORY, MAP_ONLY] if compare else [MEMORY]
        self._settings, self._place, self._places, self._memory, self._jobs = settings, place, places, memory, jobs
        self._busy = BusyBuilding(place.world, settings.seed) if settings.in_busy_building else None

    @property
    def lore(self) -> Lore:
        """The moves that memory knows."""
        return self._lore

    def recall(self) -> None:
        """Know what memory holds of the building, and where the robot stands."""
        place, memory = self._place, self._memory
        scope = prior_scope(place.world, self._settings.prior)
        self._lore = Lore.recalled(place.world, scope, self._settings.alpha0, memory, place.grid)
        self._travel = Travel.recalled(place.world, place.grid, memory)
        self._clock = RobotClock.recalled(place, self._settings.memory.robot, memory)

    def live(self, number: int, seq: int, own: OwnGoal | None, stop: Event) -> LivedByAll:
        """Drive to the goal with memory, and again on the map alone, from one start at one clock."""
        assert own is not None, "driven tasks have goals"
        if stop.is_set():
            raise Stopped
        clock, start = self._begin(own), self._start(number, seq, own.state)
        know_nothing = Travel(self._place.world, self._place.grid)
        travels = {MEMORY: self._travel, MAP_ONLY: know_nothing}
        results = {name: self._drive(number, start, own.state, clock, travels[name]) for name in self.names}
        first = results[MEMORY]
        self._walked(first)
        stands = int(first.legs[-1][-1]) if first.legs else start
        self._clock = self._clock.at(clock + first.seconds, stands)
        records = [self._lore.model_news(), *self._travel.news(), self._clock.record(self._place)]
        report = {
            "clock": clock_text(clock),
            "start": self._place.world.cells[start].tolist(),
            "map_metres": round(self._map_metres(start, own.state), 3),
        }
        known = {"places": self._lore.known_places}
        return LivedByAll(own.state, results, [one for one in records if len(one.slots)], report, known)

    def _begin(self, own: OwnGoal) -> float:
        """When the job starts: at its time, or in turn; not before the robot is free."""
        now, time = self._clock.clock, own.time
        if self._jobs is None or time is None:
            return next_start(now)
        return max(job_start(time, self._jobs.begun(lambda: list_day(now, time))), now)

    def _start(self, number: int, seq: int, goal: int) -> int:
        """The given start, or any place; in a job list, from the second job on, where the robot stands."""
        stands = self._clock.state
        in_list = self._jobs is not None and self._jobs.finished + seq > 0
        if self._places.start is not None and not in_list:
            return self._places.start
        if self._jobs is not None and stands is not None:
            return stands
        others = np.delete(np.arange(self._place.world.n_states), goal)
        return int(stream(self._settings.seed, "task", number, "start").choice(others))

    def _drive(self, number: int, start: int, goal: int, clock: float, travel: Travel) -> DrivenJob:
        """Drive a job; the noise of the building is the same for both agents."""
        world, noise = self._place.world, stream(self._settings.seed, "task", number, "drive")

        def building(way: NDArray[np.int64], clock: float) -> Drive:
            return quiet_building(way, clock, world) if self._busy is None else self._busy.drive(way, clock, noise)

        return drive_job(world, start, goal, clock, lambda now: travel.costs(now).cost, building, travel.observe)

    def _map_metres(self, start: int, goal: int) -> float:
        """Length of the shortest route on the map; 0 where there is none."""
        world = self._place.world
        route = cheapest_route(world, start, goal, np.where(world.neighbour >= 0, 1.0, np.inf))
        return 0.0 if route is None else float(route.lengths.sum()) * world.frame.cell

    def _walked(self, drive: DrivenJob) -> None:
        """Remember the moves that were made, for ways over known places."""
        world, model = self._place.world, self._lore.model
        for leg in drive.legs:
            model.target[leg[:-1], moves_along(world, leg)] = leg[1:]
            model.percept[leg] = world.percepts[leg]

    def summary(self, tasks: list[dict]) -> dict:
        """Means of each agent over thirds of the jobs, and memory compared with the map alone."""
        return summarise_drives(tasks)


def quiet_building(way: NDArray[np.int64], clock: float, world: GridWorld) -> Drive:
    """A building in which every move is made at full speed, and none is refused."""
    seconds = np.full(len(way) - 1, world.frame.cell / SPEED)
    ends = clock + seconds.cumsum()
    return Drive(way[:-1], moves_along(world, way), ends - seconds, seconds, float(ends[-1]))
