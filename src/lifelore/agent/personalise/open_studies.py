"""Studies of a memory that stay open between requests, read again when another process has changed them."""

import time
from collections.abc import Callable
from typing import NamedTuple

from lifelore.agent.personalise.study import Study, open_study
from lifelore.memory import Memory

FRESH = 1.0
"""Seconds for which an open study is used without a look at memory; fewer cost a statement for each decision."""


class _Open(NamedTuple):
    study: Study
    revision: int | None
    looked: float


class OpenStudies:
    """The studies of a memory by name.

    Parameters
    ----------
    memory : Memory
    clock : callable, optional
        Seconds, for tests.
    """

    def __init__(self, memory: Memory, clock: Callable[[], float] = time.monotonic) -> None:
        self._memory, self._clock = memory, clock
        self._open: dict[str, _Open] = {}

    def get(self, name: str) -> Study:
        """The study of that name, at most `FRESH` seconds old; errors as for `open_study`."""
        known, now = self._open.get(name), self._clock()
        if known is not None and now - known.looked < FRESH:
            return known.study
        revision = self._memory.studies.revision(name)
        if known is None or revision != known.revision:
            self._open.pop(name, None)
            known = _Open(open_study(self._memory, name), revision, now)
        self._open[name] = known._replace(looked=now)
        return known.study

    def names(self) -> list[str]:
        """Names of the studies that are open."""
        return list(self._open)

    def drop_all(self) -> None:
        """Read every study again at its next use."""
        self._open.clear()

    def drop(self, name: str) -> None:
        """Read the study again at its next use."""
        self._open.pop(name, None)
