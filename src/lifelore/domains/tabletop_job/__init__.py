"""The tabletop job: a gripper brings an object from a tray of settled objects without spilling the others.

Read in this order: `job_types` (users and grippers), `gripper_tray` (MuJoCo), `skills` (pick, put aside, push
apart, hand over), `events` (spills and knocks), `tray` (draw trays and targets), `job` (the world), `best_return`.
"""

from typing import TYPE_CHECKING

from lifelore.core.lazy_exports import lazy_exports

if TYPE_CHECKING:
    from lifelore.domains.tabletop_job.best_return import OutcomeTree as OutcomeTree
    from lifelore.domains.tabletop_job.job import PICK as PICK
    from lifelore.domains.tabletop_job.job import VERBS as VERBS
    from lifelore.domains.tabletop_job.job import TabletopJob as TabletopJob
    from lifelore.domains.tabletop_job.job_types import job_type_named as job_type_named
    from lifelore.domains.tabletop_job.tray import Tray as Tray
    from lifelore.domains.tabletop_job.tray import sample_tray as sample_tray

__all__, __getattr__, __dir__ = lazy_exports(__name__)  # pyright: ignore[reportUnsupportedDunderAll]
