"""Servers in processes of their own, each on its core: the service, and the bare route that is its limit."""

import asyncio
import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.load_client import Connection
from lifelore.core.errors import LifeloreError

STUDY: dict[str, Any] = {
    "library": {
        "types": ["calm", "lively", "moody"], "policies": ["slow", "fast", "mixed", "none"],
        "means": [[8, 2, 5, 1], [3, 9, 5, 1], [1, 2, 3, 6]], "deviations": 2.0, "counts": 40,
    },
    "rule": "sampling", "control": 0.0,
}  # fmt: skip


class Server(NamedTuple):
    """Port and process identifier of a server."""

    port: int
    process: int


def processor_seconds(process: int) -> float:
    """Processor time of a process so far."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


async def register(port: int) -> None:
    """Register `STUDY` as the study ``bench``."""
    connection = Connection(*await asyncio.open_connection("127.0.0.1", port))
    await connection.post("/v1/studies/bench", STUDY, "PUT")
    connection.close()


@contextmanager
def pinned_client() -> Iterator[int | None]:
    """This process on the last core; the core for the servers, None on a machine with a single core."""
    cores = sorted(os.sched_getaffinity(0))
    if len(cores) < 2:
        yield None
        return
    os.sched_setaffinity(0, {cores[-1]})
    try:
        yield cores[0]
    finally:
        os.sched_setaffinity(0, set(cores))


@contextmanager
def bare_server(core: int | None) -> Iterator[Server]:
    """The bare routes of `benchmarks.peers.bare_route`."""
    port = _free_port()
    with _process(["-m", "benchmarks.peers.bare_route", str(port)], port, core) as process:
        yield Server(port, process)


@contextmanager
def service(memory: Path, core: int | None) -> Iterator[Server]:
    """The service on a memory, without a limit of the rate."""
    port = _free_port()
    options = ["--port", str(port), "--rate", "0", "--memory", str(memory)]
    with _process(["-m", "lifelore.app.command_line", "serve", *options], port, core) as process:
        yield Server(port, process)


@contextmanager
def _process(arguments: list[str], port: int, core: int | None) -> Iterator[int]:
    quiet: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    process = subprocess.Popen([sys.executable, *arguments], **quiet)
    try:
        if core is not None:
            os.sched_setaffinity(process.pid, {core})
        _wait_for(process, port)
        yield process.pid
    finally:
        process.kill()
        process.wait()


def _wait_for(process: subprocess.Popen, port: int, seconds: float = 60.0) -> None:
    give_up = time.monotonic() + seconds
    while time.monotonic() < give_up:
        if process.poll() is not None:
            raise LifeloreError(
                "the service did not start; is the extra web installed? pip install 'lifelore[web]'"
            )
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return
        time.sleep(0.05)
    raise LifeloreError(f"the service did not start within {seconds:g} s")


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]
