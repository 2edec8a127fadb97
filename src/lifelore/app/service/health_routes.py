"""Routes that observe the service: health and metrics."""

import asyncio
import logging
import time
from typing import Literal

from fastapi import APIRouter, Response
from prometheus_client import CONTENT_TYPE_LATEST
from pydantic import BaseModel
from starlette.background import BackgroundTask
from starlette.concurrency import run_in_threadpool

from lifelore import __version__
from lifelore.app.service.service_state import Service
from lifelore.core.errors import StoreError
from lifelore.memory import Memory

EVERY = 5.0
"""Seconds between two trials whether the memory stores; more notice a full disk later."""
PATIENCE = 1.0
"""Seconds to wait for a trial; a busy memory takes longer, and the answer is that of the trial before."""
_log = logging.getLogger("lifelore.service")


class Health(BaseModel):
    """The state of the service."""

    status: Literal["ok"] = "ok"
    version: str = __version__


class StoreTrial:
    """Whether a memory stores, tried by a small transaction at most once in `EVERY` seconds.

    Without a token nobody learns more than that: the reason is in the log.
    """

    def __init__(self, memory: Memory) -> None:
        self._memory, self._stores = memory, True
        self._trial: asyncio.Task[None] | None = None
        self._ended = 0.0

    async def check(self) -> None:
        """Wait for a trial if one is due; StoreError where the last one failed."""
        if self._trial is None or (self._trial.done() and time.monotonic() - self._ended > EVERY):
            self._trial = asyncio.ensure_future(self._try())
        if not self._trial.done():
            await asyncio.wait({self._trial}, timeout=PATIENCE)
        if not self._stores:
            raise StoreError("the memory does not store; the log of the service has the reason")

    async def _try(self) -> None:
        stored = True
        try:
            await run_in_threadpool(store_nothing, self._memory)
        except Exception as error:
            stored = False
            if self._stores:
                _log.error("health", extra={"fields": {"error": str(error)}})
        finally:
            self._ended = time.monotonic()
        self._stores = stored


def store_nothing(memory: Memory) -> None:
    """Write to the disk of a memory and leave its content as it was; StoreError where it cannot be written."""
    with memory.together():
        number = memory.take_task("lifelore service", process="health", seconds=1)
        memory.give_back_task("lifelore service", number, process="health")


def router(service: Service) -> APIRouter:
    """The routes of health and metrics."""
    routes = APIRouter(tags=["observe"])
    trial = StoreTrial(service.memory)

    @routes.head("/healthz", include_in_schema=False)
    @routes.get("/healthz", summary="Whether the service runs and its memory stores")
    async def healthz() -> Health:
        await trial.check()
        return Health()

    @routes.get("/metrics", summary="Metrics in the text format of Prometheus", response_class=Response)
    def metrics() -> Response:
        # What takes long is computed after the answer, and is in the next one.
        later = BackgroundTask(service.watch.refresh)
        return Response(service.metrics.text(), media_type=CONTENT_TYPE_LATEST, background=later)

    return routes
