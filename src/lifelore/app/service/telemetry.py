"""Metrics for Prometheus and a log with one JSON object for each request."""

import json
import logging
import sys
import time
from collections.abc import Mapping
from functools import cache
from math import nan
from typing import Any

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest

log = logging.getLogger("lifelore.service")
MOST_ARMS = 2000
"""Largest number of (study, policy) with metrics of their own; the others are counted together as "other"."""
WATCHED = {
    "outcome_mean": "Mean of the outcomes of the last 14 days",
    "belief_entropy": "Mean entropy of the beliefs about a sample of users, in nats",
    "no_type_share": "Share of a sample of users whom no known type fits",
    "ratio_p": "p value of the number of users in the control group",
    "missing_share": "Share of the decisions older than a day without an outcome",
}
"""Numbers of a study that `watched` sets, and what they are."""
_SECONDS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 60)
_ARM = ("study", "policy", "group")


class Metrics:
    """Counters of one application; labels are route templates, studies and policies, and never users."""

    def __init__(self) -> None:
        self.registry = CollectorRegistry()
        requests = Counter("lifelore_requests", "Requests.", ("method", "route", "status"), registry=self.registry)
        seconds = Histogram(
            "lifelore_request_seconds", "Time of a request.", ("route",), registry=self.registry, buckets=_SECONDS
        )
        # To look up the children of labels takes longer than to count.
        self._of_route = cache(lambda *labels: (requests.labels(*labels), seconds.labels(labels[1])))
        self.running = Gauge("lifelore_requests_running", "Requests in progress.", registry=self.registry)
        self._decided = Counter(
            "lifelore_study_decisions", "Stored decisions of a study.", _ARM, registry=self.registry
        )
        self._observed = Counter(
            "lifelore_study_outcomes", "Stored outcomes of a study.", _ARM, registry=self.registry
        )
        # A sum of outcomes can fall, which a counter cannot.
        self._total = Gauge(
            "lifelore_study_outcome_sum", "Sum of the stored outcomes of a study.", _ARM, registry=self.registry
        )
        self._watched = {
            name: Gauge(f"lifelore_study_{name}", f"{text}; NaN: not known.", ("study",), registry=self.registry)
            for name, text in WATCHED.items()
        }
        self._arms: set[tuple[str, str]] = set()
        self._children = cache(
            lambda *arm: (self._decided.labels(*arm), self._observed.labels(*arm), self._total.labels(*arm))
        )

    def count(self, method: str, route: str, status: int, seconds: float) -> None:
        """Count an answered request and its time."""
        requests, times = self._of_route(method, route, status)
        requests.inc()
        times.observe(seconds)

    def decided(self, study: str, policy: str, control: bool, n: float = 1) -> None:
        """Count stored decisions of a policy in the control group or in the treated one."""
        self._arm(study, policy, control)[0].inc(n)

    def observed(self, study: str, policy: str, control: bool, n: float, total: float) -> None:
        """Count stored outcomes of a policy, and add their sum."""
        _, outcomes, sums = self._arm(study, policy, control)
        outcomes.inc(n)
        sums.inc(total)

    def watched(self, study: str, numbers: Mapping[str, float | None]) -> None:
        """Set the numbers of the alarms of a study, by the names of `WATCHED`."""
        for name, value in numbers.items():
            self._watched[name].labels(study).set(nan if value is None else value)

    def text(self) -> bytes:
        """All metrics in the text format of Prometheus."""
        return generate_latest(self.registry)

    def _arm(self, study: str, policy: str, control: bool) -> Any:
        arm = (study, policy)
        if arm not in self._arms and len(self._arms) >= MOST_ARMS:
            arm = ("other", "other")
        self._arms.add(arm)
        return self._children(*arm, "control" if control else "treated")


class _JsonLines(logging.Formatter):
    def format(self, record: logging.LogRecord) -> str:
        line: dict[str, Any] = {
            "time": time.strftime("%Y-%m-%dT%H:%M:%S", time.gmtime(record.created)) + f".{record.msecs:03.0f}Z",
            "level": record.levelname.lower(),
            "message": record.getMessage(),
            **getattr(record, "fields", {}),
        }
        if record.exc_info:
            line["traceback"] = self.formatException(record.exc_info)
        return json.dumps(line)


def log_to_stderr() -> None:
    """Write the service's log, and that of the web server, as JSON lines to stderr."""
    # No line says where in the code it was written, nor in which thread: that takes a third of its time.
    logging._srcfile = None  # pyright: ignore[reportAttributeAccessIssue]
    logging.logThreads = logging.logProcesses = logging.logMultiprocessing = False
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(_JsonLines())
    for name in ("lifelore.service", "uvicorn.error"):
        logger = logging.getLogger(name)
        logger.handlers, logger.propagate = [handler], False
        logger.setLevel(logging.INFO)


def log_request(fields: Mapping[str, Any], defect: BaseException | None = None) -> None:
    """Log a finished request, with the traceback of a defect."""
    if defect is not None:
        log.error("defect", extra={"fields": fields}, exc_info=defect)
    elif log.isEnabledFor(logging.INFO):
        log.info("request", extra={"fields": fields})
