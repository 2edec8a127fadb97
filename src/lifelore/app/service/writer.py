"""The thread that stores: requests that wait at the same moment share one transaction of memory.

SQLite has one writer at a time, and each transaction waits for the disk. A request is answered after the
transaction that holds it has been committed.
"""

import asyncio
import queue
import threading
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from lifelore.memory import Memory

MOST = 64
"""Largest number of requests in a transaction; more let each of them wait longer."""


PATIENCE = 0.002
"""Seconds to wait for another request where the last transaction had several: a commit takes longer than that."""


class _Job(NamedTuple):
    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    loop: asyncio.AbstractEventLoop
    future: asyncio.Future[Any]


class Writer:
    """A thread that runs functions that store in a memory, in the order of their requests.

    Parameters
    ----------
    memory : Memory
    undone : callable
        Called after a transaction that memory refused: what main memory holds of it must be read again.
    """

    def __init__(self, memory: Memory, undone: Callable[[], None]) -> None:
        self._memory, self._undone = memory, undone
        self._jobs: queue.SimpleQueue[_Job | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._work, name="lifelore writer", daemon=True)
        self._thread.start()

    async def run(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """The result of a function, once all that it stored is committed; its errors as it raised them."""
        loop = asyncio.get_running_loop()
        job = _Job(function, arguments, loop, loop.create_future())
        self._jobs.put(job)
        return await job.future

    def stop(self) -> None:
        """Finish the waiting requests and end the thread."""
        self._jobs.put(None)
        self._thread.join()

    def _work(self) -> None:
        patience = 0.0
        while (first := self._jobs.get()) is not None:
            jobs, last = [first], False
            while len(jobs) < MOST and not last:
                try:
                    following = self._jobs.get(timeout=patience)
                except queue.Empty:
                    break
                last = following is None
                if following is not None:
                    jobs.append(following)
            _deliver(jobs, self._results(jobs))
            if last:
                return
            patience = PATIENCE if len(jobs) > 1 else 0.0

    def _results(self, jobs: Sequence[_Job]) -> list[tuple[Any, Exception | None]]:
        try:
            with self._memory.together():
                return [_result(job) for job in jobs]
        except Exception as error:
            self._undone()
            return [(None, error)] * len(jobs)


def _result(job: _Job) -> tuple[Any, Exception | None]:
    try:
        return job.function(*job.arguments), None
    except Exception as error:
        return None, error


def _deliver(jobs: Sequence[_Job], results: Sequence[tuple[Any, Exception | None]]) -> None:
    """Answer all jobs of a transaction by one call of their event loop."""

    def answer() -> None:
        for job, (result, error) in zip(jobs, results, strict=True):
            if job.future.done():
                continue
            if error is None:
                job.future.set_result(result)
            else:
                job.future.set_exception(error)

    jobs[0].loop.call_soon_threadsafe(answer)
