"""Number of finished jobs of a job list: an interrupted list goes on with its first unfinished job.

A record of kind "job list" holds the number in slot 0, and in slot 1 the day of the list: midnight in seconds
since 1970, 0 for a list without times; the newest counts. Its key is a hash of the robot, the building and the
list's names, points and times.
"""

import hashlib
import json
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from lifelore.agent.live.goals.destinations import Destination
from lifelore.agent.live.goals.job_list import Job, named_points
from lifelore.core.protocols import Record
from lifelore.memory import Memory

KIND, VERSION = "job list", 1


@dataclass
class JobProgress:
    """A robot's progress in one job list.

    key : of the robot, the building and the list
    n_jobs : number of jobs of the list
    finished : number of jobs finished before this life, below `n_jobs`
    day : midnight of the day whose times of day the list means, seconds since 1970; 0 before its first job
    """

    key: str
    n_jobs: int
    finished: int = 0
    day: float = 0.0

    @classmethod
    def recalled(
        cls, jobs: tuple[Job, ...], robot: str, building: str, memory: Memory, again: bool = False
    ) -> "JobProgress":
        """The progress that memory holds; none for a list that is new, was finished or is started `again`."""
        listed = [(job.time, job.destination.name, job.destination.point) for job in jobs]
        text = json.dumps([robot, building, listed])
        key = hashlib.sha256(text.encode()).hexdigest()[:32]
        record = None if again else memory.recall(KIND, key, VERSION)
        finished, day = (0, 0) if record is None else np.resize(np.append(record.values, 0), 2).tolist()
        return cls(key, len(jobs), finished, float(day)) if finished < len(jobs) else cls(key, len(jobs))

    def begun(self, day: Callable[[], float]) -> float:
        """The day of the list; `day` gives it for the first job."""
        self.day = self.day or day()
        return self.day

    def unfinished(self, jobs: tuple[Job, ...]) -> tuple[Job, ...]:
        """The jobs that are left; a name that the list defines has its point, also where that line is finished."""
        points = named_points(jobs)

        def located(end: Destination) -> Destination:
            return end if end.name is None else Destination(end.point or points.get(end.name), end.name)

        return tuple(replace(job, destination=located(job.destination)) for job in jobs[self.finished :])

    def record(self, done: int) -> Record:
        """The record by which memory knows that this life has finished `done` more jobs."""
        finished = self.finished + done
        about = {"finished": finished, "jobs": self.n_jobs}
        return Record(KIND, self.key, VERSION, "newest", np.arange(2), np.array([finished, int(self.day)]), about)

    def notice(self) -> str:
        """A line for the user of a list that goes on."""
        return (
            f"job list: {self.finished} of {self.n_jobs} jobs were finished in an earlier run; this run goes on "
            f"with job {self.finished + 1}, --set again=true starts with the first"
        )
