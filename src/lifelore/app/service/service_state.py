"""The state that all routes share: the open memory, open studies, settings and metrics."""

from dataclasses import dataclass, field

from lifelore.app.service.settings import ServiceSettings
from lifelore.app.service.study_watch import OpenStudies, StudyWatch
from lifelore.app.service.telemetry import Metrics
from lifelore.app.service.worker_process import WorkerProcess
from lifelore.app.service.writer import Writer
from lifelore.memory import Memory


@dataclass
class Service:
    """The state of one application.

    Parameters
    ----------
    settings : ServiceSettings
    memory : Memory
        Open until the application stops.
    """

    settings: ServiceSettings
    memory: Memory
    metrics: Metrics = field(default_factory=Metrics)
    worker: WorkerProcess = field(default_factory=WorkerProcess)
    writer: Writer = field(init=False)
    studies: OpenStudies = field(init=False)
    watch: StudyWatch = field(init=False)

    def __post_init__(self) -> None:
        self.studies = OpenStudies(self.memory)
        self.watch = StudyWatch(self.memory, self.studies, self.metrics)
        self.writer = Writer(self.memory, self.studies, self.metrics, self.settings.seed)
