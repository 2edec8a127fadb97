"""Connections to other programs: Stable-Baselines3, rosbags, PDDL planners, clients of the service."""

from typing import TYPE_CHECKING

from lifelore.core.lazy_exports import lazy_exports

if TYPE_CHECKING:
    from lifelore.bridges.prior_mask import PriorMask as PriorMask
    from lifelore.bridges.study_client import StudyClient as StudyClient

__all__, __getattr__, __dir__ = lazy_exports(__name__)  # pyright: ignore[reportUnsupportedDunderAll]
