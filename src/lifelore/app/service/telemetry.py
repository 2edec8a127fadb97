"""Metrics for Prometheus and a log with one JSON object for each request."""

import json
import logging
import sys
import time
from collections.abc import Mapping
from functools import cache
from typing import Any

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest
from prometheus_client.exposition import CONTENT_TYPE_LATEST

__all__ = ["CONTENT_TYPE_LATEST", "Metrics", "log_request", "log_to_stderr"]

log = logging.getLogger("lifelore.service")
_SECONDS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 60)


class Metrics:
    """Counters of one application; labels are route templates, never parts of requests."""

    def __init__(self) -> None:
        self.registry = CollectorRegistry()
        self.requests = Counter(
            "lifelore_requests", "Requests.", ("method", "route", "status"), registry=self.registry
        )
        self.seconds = Histogram(
            "lifelore_request_seconds", "Time of a request.", ("route",), buckets=_SECONDS, registry=self.registry
        )
        self.running = Gauge("lifelore_requests_running", "Requests in progress.", registry=self.registry)
        self.decisions = Counter("lifelore_decisions", "Stored decisions.", registry=self.registry)
        self.outcomes = Counter("lifelore_outcomes", "Stored outcomes.", registry=self.registry)
        # To look up the children of labels takes longer than to count.
        self._counted = cache(self.requests.labels)
        self._timed = cache(self.seconds.labels)

    def count(self, method: str, route: str, status: int, seconds: float) -> None:
        """Count a finished request."""
        self._counted(method, route, str(status)).inc()
        self._timed(route).observe(seconds)

    def text(self) -> bytes:
        """All metrics in the text format of Prometheus."""
        return generate_latest(self.registry)


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
