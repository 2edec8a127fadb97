"""`bench serve`: decisions and outcomes over HTTP on loopback, beside a bare FastAPI route as the limit.

Server and client run on a core each. A unit of work of the service is a decision and its outcome, two requests.
The bare route is asked twice for a unit. The memory is a file of SQLite with ``synchronous=FULL``.
"""

import asyncio
import itertools
import os
import socket
import subprocess
import sys
import time
from collections.abc import AsyncIterator, Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np

from lifelore.core.errors import LifeloreError
from lifelore.core.protocols import Progress
from lifelore.experiments.bench.rounds import at_least, at_most, paired_ratio, row
from lifelore.experiments.bench.service.load_client import SCENARIO, Connection, run_load

CONNECTIONS, SECONDS = 32, 2.0
"""Connections, and seconds of a measurement; more seconds let less chance into the 99th percentile."""
ROUNDS = 5
"""Largest number of rounds, so that the benchmark ends within a minute."""
BATCH, BATCH_CONNECTIONS = 10_000, 2
PAIRS, P99_MS, BATCHED, SHARE = 2000, 20.0, 200_000, 0.4
"""Goals: pairs per second, 99th percentile in ms, decisions of batches per second, share of the bare route."""
STUDY = {
    "library": {
        "types": ["calm", "lively", "moody"], "policies": ["slow", "fast", "mixed", "none"],
        "means": [[8, 2, 5, 1], [3, 9, 5, 1], [1, 2, 3, 6]], "deviations": 2.0,
    },
    "rule": "sampling", "control": 0.0,
}  # fmt: skip


def bench_serve(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `lifelore.experiments.bench.bench`."""
    rounds = min(repeats, ROUNDS)
    rates, cpu, p99 = ({"bare": [], "pairs": [], "batch": []} for _ in range(3))
    with (
        TemporaryDirectory() as folder,
        _pinned_client() as core,
        _bare(core) as bare,
        _service(folder, core) as ours,
    ):
        asyncio.run(_register(ours.port))
        for scenario, server in ((_bare_pairs, bare), (_pairs, ours), (_batches, ours)):
            _loaded(server, scenario, 2, 0.5)  # the first requests import and compile
        for number in range(rounds):
            for name, server, scenario, connections in (
                ("bare", bare, _bare_pairs, CONNECTIONS),
                ("pairs", ours, _pairs, CONNECTIONS),
                ("batch", ours, _batches, BATCH_CONNECTIONS),
            ):
                measured = _loaded(server, scenario, connections, SECONDS)
                rates[name].append(measured.units)
                cpu[name].append(measured.cpu_ms)
                p99[name].append(measured.p99_ms)
            progress(number + 1, rounds, "rounds")
    share = paired_ratio(rates["pairs"], rates["bare"])
    cpu_share = paired_ratio(cpu["bare"], cpu["pairs"])
    names = "bare route, asked twice", "decision and outcome", "batches of decisions"
    return {
        "rows": [
            row(names[0], median(rates["bare"]), "pairs/s"),
            row(names[1], median(rates["pairs"]), "pairs/s", names[0], share),
            row(f"99th percentile of a request, {CONNECTIONS} connections", median(p99["pairs"]), "ms"),
            row(names[2], BATCH * median(rates["batch"]), "decisions/s"),
            row(f"{names[0]}: processor time of the server", median(cpu["bare"]), "ms"),
            row(f"{names[1]}: processor time of the server", median(cpu["pairs"]), "ms"),
            row(f"{names[2]}: processor time of the server", 1e3 * median(cpu["batch"]) / BATCH, "µs"),
        ],
        "goals": [
            at_least("decisions and outcomes per second", PAIRS, median(rates["pairs"])),
            at_least(f"{names[1]} / {names[0]}", SHARE, share),
            at_least("the same by processor time, for busy machines", SHARE, cpu_share),
            at_most("99th percentile of a request, ms", P99_MS, median(p99["pairs"])),
            at_least("decisions of batches per second", BATCHED, BATCH * median(rates["batch"])),
        ],
    }


class _Server(NamedTuple):
    port: int
    process: int


class _Load(NamedTuple):
    """Units of work per second; processor milliseconds of the server for each; 99th percentile of a request."""

    units: float
    cpu_ms: float
    p99_ms: float


def _loaded(server: _Server, scenario: SCENARIO, connections: int, seconds: float) -> _Load:
    began, before = time.perf_counter(), _processor_seconds(server.process)
    units, requests = asyncio.run(run_load(server.port, scenario, connections, seconds))
    elapsed, spent = time.perf_counter() - began, _processor_seconds(server.process) - before
    return _Load(units, 1e3 * spent / (units * elapsed), 1e3 * float(np.quantile(requests, 0.99)))


def _processor_seconds(process: int) -> float:
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


async def _register(port: int) -> None:
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    import json

    body = json.dumps(STUDY)
    writer.write(
        f"PUT /v1/studies/bench HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
        f"Content-Length: {len(body)}\r\nConnection: close\r\n\r\n{body}".encode()
    )
    answer = await reader.read()
    writer.close()
    if not answer.startswith(b"HTTP/1.1 200"):
        raise LifeloreError(f"the service refused the study: {answer[-200:].decode()}")


async def _bare_pairs(connection: Connection, number: int) -> AsyncIterator[None]:
    while True:
        await connection.post("/bare", {"user": f"user {number}"})
        await connection.post("/bare", {"decision": f"user {number}", "outcome": 1.0})
        yield


async def _pairs(connection: Connection, number: int) -> AsyncIterator[None]:
    for n in itertools.count():
        made = await connection.post("/v1/studies/bench/decisions", {"user": f"user {number} {n % 50}"})
        ended = {"decision": made["decision"], "outcome": float(n % 10)}
        await connection.post("/v1/studies/bench/outcomes", ended)
        yield


async def _batches(connection: Connection, number: int) -> AsyncIterator[None]:
    users = [f"user {number} {place}" for place in range(BATCH)]
    while True:
        await connection.post("/v1/studies/bench/panel/decisions", {"users": users})
        yield


@contextmanager
def _pinned_client() -> Iterator[int | None]:
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
def _bare(core: int | None) -> Iterator[_Server]:
    port = _free_port()
    with _process(["-m", "lifelore.experiments.bench.service.bare_route", str(port)], port, core) as process:
        yield _Server(port, process)


@contextmanager
def _service(folder: str, core: int | None) -> Iterator[_Server]:
    port = _free_port()
    options = ["--port", str(port), "--rate", "0", "--memory", str(Path(folder) / "bench.db")]
    with _process(["-m", "lifelore.app.command_line", "serve", *options], port, core) as process:
        yield _Server(port, process)


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
