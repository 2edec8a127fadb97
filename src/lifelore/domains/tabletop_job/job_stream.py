"""A life of tabletop jobs: a new tray for every task, and hidden types that depend on an observable context."""

from dataclasses import dataclass

from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.domains.tabletop_job.job import TabletopJob
from lifelore.domains.tabletop_job.job_types import JOB_TYPES, job_type_named
from lifelore.domains.tabletop_job.tray import sample_tray
from lifelore.domains.task_stream import DrawnTask, TaskStream

ALL_TYPES = tuple(job_type.name for job_type in JOB_TYPES)


@dataclass(frozen=True)
class TabletopJobs:
    """Tabletop jobs by number.

    Parameters
    ----------
    stream : TaskStream
        Its types are names of `job_types.JOB_TYPES`; its contexts stand for the rooms from which users call.
    seed : int
        Of the trays, so that lives of different streams can share their trays.
    settings : TabletopSettings, optional
        What the trays hold; 2 to 7 objects by default.
    """

    stream: TaskStream
    seed: int = 0
    settings: TabletopSettings | None = None

    def task(self, number: int) -> tuple[DrawnTask, TabletopJob]:
        """Task `number` and its world; the same for the same number.

        Raises
        ------
        NotFoundError
            The stream names an unknown type.
        """
        drawn = self.stream.draw(number)
        settings = self.settings or TabletopSettings()
        tray = sample_tray(self.seed, number, settings)
        return drawn, TabletopJob(tray, job_type_named(drawn.hidden_type), self.seed, settings.camera)
