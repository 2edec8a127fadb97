"""Decisions and outcomes over HTTP on loopback, beside a bare FastAPI route as the limit.

Server and client run on a core each. A unit of work of the service is a decision and its outcome, two requests.
The bare route is asked twice for a unit. The memory is a file of SQLite with ``synchronous=FULL``.
"""

import asyncio
import itertools
import time
from collections.abc import AsyncIterator
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from benchmarks.load_client import SCENARIO, Connection, run_load
from benchmarks.rounds import at_least, at_most, paired_ratio, row
from benchmarks.server_process import (
    Server,
    bare_server,
    pinned_client,
    processor_seconds,
    register,
    service,
)
from lifelore.core.protocols import Progress

CONNECTIONS, SECONDS = 32, 2.0
"""Connections, and seconds of a measurement; more seconds let less chance into the 99th percentile."""
ROUNDS = 5
"""Largest number of rounds, so that the benchmark ends within a minute."""
BATCH, BATCH_CONNECTIONS = 10_000, 2
PAIRS, P99_MS, BATCHED, SHARE = 2000, 20.0, 200_000, 0.4
"""Goals: pairs per second, 99th percentile in ms, decisions of batches per second, share of the bare route."""


def bench_serve(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    rounds = min(repeats, ROUNDS)
    rates, cpu, p99 = ({"bare": [], "pairs": [], "batch": []} for _ in range(3))
    with (
        TemporaryDirectory() as folder,
        pinned_client() as core,
        bare_server(core) as bare,
        service(Path(folder) / "bench.db", core) as ours,
    ):
        asyncio.run(register(ours.port))
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


class _Load(NamedTuple):
    """Units of work per second; processor milliseconds of the server for each; 99th percentile of a request."""

    units: float
    cpu_ms: float
    p99_ms: float


def _loaded(server: Server, scenario: SCENARIO, connections: int, seconds: float) -> _Load:
    began, before = time.perf_counter(), processor_seconds(server.process)
    units, requests = asyncio.run(run_load(server.port, scenario, connections, seconds))
    elapsed, spent = time.perf_counter() - began, processor_seconds(server.process) - before
    return _Load(units, 1e3 * spent / (units * elapsed), 1e3 * float(np.quantile(requests, 0.99)))


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
