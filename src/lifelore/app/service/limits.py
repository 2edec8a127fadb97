"""Limits of a request: the size of its body, its time, and the rate of a client."""

import asyncio
import time
from collections import OrderedDict
from collections.abc import Callable
from typing import Any

from starlette.exceptions import HTTPException

WINDOW = 10.0
"""Seconds of requests that a client may send at once after a pause."""
CLIENTS = 10_000
"""Largest number of clients that are counted; the one not seen for longest is forgotten."""


class RateLimit:
    """A bucket of permits for each client, filled at a constant rate.

    Parameters
    ----------
    rate : float
        Requests per second; 0: no limit.
    clock : callable, optional
        Seconds, for tests.
    window : float
        Seconds of permits in a full bucket.
    """

    def __init__(self, rate: float, clock: Callable[[], float] = time.monotonic, window: float = WINDOW) -> None:
        self.rate, self._clock = rate, clock
        self._full = max(1.0, rate * window)
        self._buckets: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def wait_for(self, client: str) -> float:
        """Take a permit of a client: 0, or the seconds until there is one."""
        if not self.rate:
            return 0.0
        now = self._clock()
        level, before = self._buckets.pop(client, (self._full, now))
        level = min(self._full, level + (now - before) * self.rate)
        wait = 0.0 if level >= 1 else (1 - level) / self.rate
        self._buckets[client] = (level if wait else level - 1, now)
        if len(self._buckets) > CLIENTS:
            self._buckets.popitem(last=False)
        return wait


class Deadlines:
    """Cancels requests that take too long; one timer looks after all of them, since one for each is dear.

    Parameters
    ----------
    seconds : float
        Time of a request; it is cancelled at most a twentieth of this time, or a second, later.
    """

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds
        self._pause = min(1.0, seconds / 20)
        # In the order of their times, so that the timer looks at the first ones alone.
        self._began: dict[asyncio.Task[Any], float] = {}
        self._overdue: set[asyncio.Task[Any]] = set()
        self._loop: asyncio.AbstractEventLoop | None = None

    def begin(self) -> asyncio.Task[Any]:
        """Begin the time of the task that runs now."""
        loop = asyncio.get_running_loop()
        task = asyncio.current_task(loop)
        assert task is not None, "requests are tasks"
        self._began[task] = loop.time()
        if self._loop is not loop:
            self._loop = loop
            loop.call_later(self._pause, self._look, loop)
        return task

    def renew(self, task: asyncio.Task[Any]) -> None:
        """Begin the time of a task again, which has just sent a piece of a long answer."""
        if self._began.pop(task, None) is not None:
            self._began[task] = task.get_loop().time()

    def end(self, task: asyncio.Task[Any]) -> bool:
        """End the time of a task; whether it was cancelled for its time."""
        self._began.pop(task, None)
        if task not in self._overdue:
            return False
        self._overdue.remove(task)
        task.uncancel()
        return True

    @property
    def running(self) -> int:
        """Number of requests in progress."""
        return len(self._began)

    def _look(self, loop: asyncio.AbstractEventLoop) -> None:
        if self._loop is not loop:
            return
        last = loop.time() - self._seconds
        for task, began in list(self._began.items()):
            if began > last:
                break
            del self._began[task]
            self._overdue.add(task)
            task.cancel()
        if self._began:
            loop.call_later(self._pause, self._look, loop)
        else:
            self._loop = None


def too_large(largest: int) -> str:
    """The message for a body above the limit."""
    return f"the body must have at most {largest} bytes; send it in parts"


def limited_body(receive: Callable[[], Any], largest: int) -> Callable[[], Any]:
    """`receive` of ASGI that raises an HTTPException with status 413 beyond `largest` bytes."""
    received = 0

    async def limited() -> Any:
        nonlocal received
        message = await receive()
        if message["type"] == "http.request":
            received += len(message.get("body", b""))
            if received > largest:
                raise HTTPException(413, too_large(largest))
        return message

    return limited
