"""The service with its pages beside a life, in a process of its own, for as long as the life takes."""

import json
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from tempfile import TemporaryFile

from lifelore.core.errors import InputError, StoreError

PORT = 8321
"""Port where none is given."""
STOPPING = 15.0
"""Seconds that the service gets to answer what it has begun."""


@contextmanager
def pages_beside(serve: bool, port: int | None, memory: str | None) -> Iterator[None]:
    """Serve the pages over a memory inside the block, and print the address of the page of lives on stderr.

    Parameters
    ----------
    serve : bool
        With False the block runs without a service.
    port : int, optional
        0: any free port; default: `PORT`.
    memory : str, optional
        As for `open_memory`.

    Raises
    ------
    InputError
        A port without `serve`.
    StoreError
        The service does not start: the port is taken, an extra is missing, or the memory cannot be opened.
    """
    if port is not None and not serve:
        raise InputError(f"port belongs to --serve, got {port}; add --serve, or leave port out")
    if not serve:
        yield
        return
    command = [sys.executable, "-m", "lifelore.app.command_line", "serve", "--json", "--until-eof"]
    command += ["--port", str(PORT if port is None else port)]
    command += [] if memory is None else ["--memory", memory]
    with TemporaryFile("w+") as log:
        # A session of its own: Ctrl-C stops the life first. SIGTERM ends the block, and with it the service.
        before = signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(128 + number))
        # Its standard input is a pipe that closes when this process dies, also by SIGKILL; it ends then.
        process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=log, text=True, start_new_session=True
        )
        try:
            assert process.stdout is not None, "it is a pipe"
            line = process.stdout.readline()
            if not line:
                process.wait()
                log.seek(0)
                last = (log.read().strip().splitlines() or ["it said nothing"])[-1]
                raise StoreError(f"the pages cannot be served: {last.removeprefix('lifelore: ')}")
            print(f"pages at {json.loads(line)['url']}/life until the life ends", file=sys.stderr, flush=True)
            yield
        finally:
            signal.signal(signal.SIGTERM, before)
            process.terminate()
            try:
                process.wait(STOPPING)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
            for pipe in (process.stdin, process.stdout):
                if pipe is not None:
                    pipe.close()
