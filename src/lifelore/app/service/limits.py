"""Limits of a request: the size of its body and the rate of its client."""

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
