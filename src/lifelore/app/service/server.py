"""Runs the application with uvicorn until a signal stops it; requests in progress are answered first.

Connections close where the headers of a request are slow or too large.
"""

import multiprocessing
import os
import signal
import socket
import threading
import time
from collections.abc import Callable
from typing import Any

import uvicorn
from fastapi import FastAPI
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

from lifelore.app.service.application import create_app
from lifelore.app.service.settings import ServiceSettings, is_loopback
from lifelore.app.service.telemetry import log_to_stderr
from lifelore.core.errors import InputError, StoreError

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


GRACE = 5
"""Seconds for requests in progress after a signal; those that take longer are refused."""
LONGEST_STOP = 9.0
"""Seconds after a signal at which the process ends, also where a thread still works on an abandoned request."""


def serve(
    settings: ServiceSettings,
    host: str,
    port: int,
    ready: Callable[[str], None],
    create: Callable[[ServiceSettings], FastAPI] = create_app,
) -> None:
    """Serve until SIGINT or SIGTERM, with httptools, and with uvloop where it is installed.

    Parameters
    ----------
    settings : ServiceSettings
    host, port : str, int
        Port 0: any free port.
    ready : callable
        Called with the URL once connections are accepted.
    create : callable
        Makes the application; by default without pages.

    Raises
    ------
    InputError
        A host that others reach needs a token file.
    StoreError
        The port is taken, or the memory cannot be opened.
    """
    if settings.token_file is None and not is_loopback(host):
        raise InputError(
            f"host must be 127.0.0.1 without tokens, got '{host}'; add a token: --add-token NAME --token-file FILE"
        )
    app = create(settings)
    listening = _listening(host, port)
    name = f"[{host}]" if ":" in host else host
    log_to_stderr()
    config = uvicorn.Config(
        app,
        http=PatientProtocol,
        log_config=None,
        access_log=False,
        server_header=False,
        timeout_graceful_shutdown=GRACE,
        ws="none",
    )
    # uvicorn raises the signal again when it has stopped; SIGTERM has done its work then. A process started in the
    # background of a shell inherits an ignored SIGINT; the status of a stopped service is the same there.
    signal.signal(signal.SIGTERM, lambda number, frame: None)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    # The file of tokens is read again by itself; other programs send SIGHUP to have that done.
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    ready(f"http://{name}:{listening.getsockname()[1]}")
    _Server(config).run(sockets=[listening])


class _Server(uvicorn.Server):
    """A server that stops within `LONGEST_STOP` seconds of a signal, whatever runs, and at once at the second."""

    def handle_exit(self, sig: int, frame: Any) -> None:
        if self.should_exit:
            _end(sig)
        threading.Thread(target=_end_later, args=(sig,), daemon=True).start()
        super().handle_exit(sig, frame)


def _end_later(sig: int) -> None:
    time.sleep(LONGEST_STOP)
    _end(sig)


def _end(sig: int) -> None:
    """End this process without waiting for its threads; what was answered is stored."""
    for child in multiprocessing.active_children():
        child.kill()
    os._exit(128 + sig if sig == signal.SIGINT else 0)


def _listening(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # Named as TCP, so that asyncio sends small answers at once (TCP_NODELAY) and not after 40 ms.
    listening = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind((host, port))
        listening.listen(2048)
    except (OSError, OverflowError) as error:
        listening.close()
        reason = getattr(error, "strerror", None) or str(error)
        raise StoreError(f"port {port} of {host} cannot be used: {reason}; choose another with --port") from None
    return listening
