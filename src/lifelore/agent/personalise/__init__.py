"""Personalisation of an interactive system: a study chooses the best of N policies for each of its users.

Read in this order: `registration` (a policy library becomes a study), `study`, `decisions` (choices and outcomes),
`study_report`, `fitting` (a library from a log), `evaluate` (policies that were not in place), `explanation` (the
evidence behind a user's belief), `adaptation` (BEAT).
"""

from typing import TYPE_CHECKING

from lifelore.core.lazy_exports import lazy_exports

if TYPE_CHECKING:
    from lifelore.agent.personalise.decisions import Request as Request
    from lifelore.agent.personalise.decisions import choose as choose
    from lifelore.agent.personalise.decisions import decide as decide
    from lifelore.agent.personalise.decisions import observe as observe
    from lifelore.agent.personalise.decisions import update as update
    from lifelore.agent.personalise.fitting.fit import FitSettings as FitSettings
    from lifelore.agent.personalise.fitting.fit import fit as fit
    from lifelore.agent.personalise.log.log_format import LogFormat as LogFormat
    from lifelore.agent.personalise.study import open_study as open_study
    from lifelore.agent.personalise.study_report import report as report

__all__, __getattr__, __dir__ = lazy_exports(__name__)  # pyright: ignore[reportUnsupportedDunderAll]
