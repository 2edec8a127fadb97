"""Studies that stay open between requests, and their traffic, at most a minute old, for /study and for metrics."""

import threading
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any, NamedTuple

from lifelore.agent.personalise.study import Study, open_study
from lifelore.agent.personalise.traffic import traffic
from lifelore.app.service.telemetry import Metrics
from lifelore.core.errors import LifeloreError
from lifelore.memory import Memory

UNSEEN = 1.0
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
        """The study of that name, at most `UNSEEN` seconds old; errors as for `open_study`."""
        known, now = self._open.get(name), self._clock()
        if known is not None and now - known.looked < UNSEEN:
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


FRESH = 60.0
"""Seconds for which an answer holds; fewer read the newest decisions more often."""
DAYS = 14
"""Window of the metrics."""


class _Seen(NamedTuple):
    study: Study
    at: float
    document: dict[str, Any]


class StudyWatch:
    """The newest traffic of the studies that are asked for.

    Parameters
    ----------
    memory : Memory
    studies : OpenStudies
    metrics : Metrics
        Get the numbers of the alarms, over `DAYS`.
    clock : callable, optional
        Seconds, for tests.
    """

    def __init__(
        self,
        memory: Memory,
        studies: OpenStudies,
        metrics: Metrics,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._memory, self._studies, self._metrics, self._clock = memory, studies, metrics, clock
        self._seen: dict[tuple[str, int], _Seen] = {}
        self._lock = threading.Lock()

    def traffic(self, name: str, days: int = DAYS) -> dict[str, Any]:
        """The document of `traffic`, at most a minute old, with its age in seconds; errors as for `open_study`."""
        with self._lock:
            study, now = self._studies.get(name), self._clock()
            seen = self._seen.get((name, days))
            if seen is None or seen.study is not study or now - seen.at >= FRESH:
                seen = _Seen(study, now, traffic(self._memory, study, days))
                self._seen[name, days] = seen
                if days == DAYS:
                    self._metrics.watched(name, _numbers(seen.document))
        return seen.document | {"age": round(now - seen.at, 1)}

    def refresh(self) -> None:
        """Bring the metrics of one open study up to date, the one that has waited longest."""
        with suppress(LifeloreError):
            names = sorted(self._studies.names(), key=self._last)
            if names and self._clock() - self._last(names[0]) >= FRESH:
                self.traffic(names[0])

    def _last(self, name: str) -> float:
        seen = self._seen.get((name, DAYS))
        return float("-inf") if seen is None else seen.at


def _numbers(document: dict[str, Any]) -> dict[str, float | None]:
    totals = [point[group] for point in document["points"] for group in ("personal", "control")]
    outcomes = sum(one["outcomes"] for one in totals)
    beliefs, ratio, missing = (document[kind] or {} for kind in ("beliefs", "ratio", "missing"))
    return {
        "outcome_mean": sum(one["sum"] for one in totals) / outcomes if outcomes else None,
        "belief_entropy": beliefs.get("entropy"),
        "no_type_share": beliefs.get("unknown"),
        "ratio_p": ratio.get("p"),
        "missing_share": missing.get("share"),
    }
