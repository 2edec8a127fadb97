"""Connections of the web server that close where the headers of a request are slow or too large."""

from typing import Any

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

HEADERS = 10.0
"""Seconds for the headers of a request; a connection that is slower closes after twice this time at the latest."""
LARGEST_HEADERS = 65_536
"""Bytes of the headers of a request, at most."""


class PatientProtocol(HttpToolsProtocol):
    """A connection of uvicorn that does not wait for headers without end.

    uvicorn itself waits for as many headers as come, for ever once their first byte has come. Here a timer for
    each connection, and none for each request, sees whether the same request is awaited as at its last look.
    """

    _awaited: Any = None
    _heading, _unread = False, 0

    def connection_made(self, transport: Any) -> None:
        """Begin to look after a new connection."""
        super().connection_made(transport)
        self._awaited = self
        self.loop.call_later(HEADERS, self._look)

    def on_message_begin(self) -> None:
        """The first byte of a request has come."""
        self._heading, self._unread = True, 0
        super().on_message_begin()

    def on_headers_complete(self) -> None:
        """The headers of a request are complete."""
        self._heading = False
        super().on_headers_complete()

    def data_received(self, data: bytes) -> None:
        """Read data, and close where headers grow too large."""
        super().data_received(data)
        if self._heading:
            self._unread += len(data)
            if self._unread > LARGEST_HEADERS:
                self.transport.abort()

    def _look(self) -> None:
        if self not in self.connections:
            return  # closed
        # Between two requests, the last one names the state; in a request, `self` does, which is no request.
        cycle = self.cycle
        state = cycle if cycle is None or cycle.response_complete else self
        if state is self._awaited and state is not self:
            self.transport.abort()
            return
        self._awaited = state
        self.loop.call_later(HEADERS, self._look)
