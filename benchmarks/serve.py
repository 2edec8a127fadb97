"""Decisions and outcomes over HTTP on loopback, beside bare Starlette routes that store a row.

Server and client run on a core each. A unit of work is a decision and its outcome, two requests, both stored in a
file of SQLite with ``synchronous=FULL`` before the answer. The bare routes are asked twice for a unit; one commits
each row, the other all rows that wait.
"""

import asyncio
import itertools
import json
import time
from collections.abc import AsyncIterator
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from benchmarks.load_client import SCENARIO, Connection, run_load
from benchmarks.rounds import Rates, at_least, at_most, paired_ratio, row
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
"""Largest number of rounds, so that the benchmark ends within minutes."""
BATCH, MANY = 1000, 100_000
PAIRS, CPU_MS, P99_MS, BATCHED, SECONDS_OF_MANY, BESIDE_MS, SHARE = 3000, 0.3, 20.0, 50_000, 1.0, 50.0, 0.5
"""Goals: see `bench_serve`."""


def bench_serve(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    rounds = min(repeats, ROUNDS)
    names = ("each", "group", "pairs", "batch")
    rates: Rates = {name: [] for name in names}
    cpu: Rates = {name: [] for name in names}
    p99: Rates = {name: [] for name in names}
    many, beside = [], []
    with (
        TemporaryDirectory() as folder,
        pinned_client() as core,
        bare_server(core) as bare,
        service(Path(folder) / "bench.db", core) as ours,
    ):
        asyncio.run(register(ours.port))
        scenarios: tuple[tuple[str, Server, SCENARIO, int], ...] = (
            ("each", bare, _bare("/row"), CONNECTIONS),
            ("group", bare, _bare("/group"), CONNECTIONS),
            ("pairs", ours, _pairs, CONNECTIONS),
            ("batch", ours, _batches, 2),
        )
        for _, server, scenario, _ in scenarios:
            _loaded(server, scenario, 2, 0.5)  # the first requests import and compile
        for number in range(rounds):
            for name, server, scenario, connections in scenarios:
                measured = _loaded(server, scenario, connections, SECONDS)
                rates[name].append(measured.units)
                cpu[name].append(measured.cpu_ms)
                p99[name].append(measured.p99_ms)
            seconds, slowest = asyncio.run(_many_and_a_single(ours.port, number))
            many.append(seconds)
            beside.append(slowest)
            progress(number + 1, rounds, "rounds")
    share = paired_ratio(rates["pairs"], rates["each"])
    of_group = paired_ratio(rates["pairs"], rates["group"])
    each, group = "bare route that commits each row", "bare route that commits what waits"
    batched = BATCH * median(rates["batch"])
    return {
        "rows": [
            row(each, median(rates["each"]), "pairs/s"),
            row(group, median(rates["group"]), "pairs/s"),
            row("decision and outcome", median(rates["pairs"]), "pairs/s", each, share),
            row(
                "decision and outcome, beside the other route", median(rates["pairs"]), "pairs/s", group, of_group
            ),
            row(f"99th percentile of a request, {CONNECTIONS} connections", median(p99["pairs"]), "ms"),
            row(f"99th percentile of a request, {group}", median(p99["group"]), "ms"),
            row("processor time of a decision and its outcome", median(cpu["pairs"]), "ms"),
            row(f"processor time of a pair, {group}", median(cpu["group"]), "ms"),
            row(f"batches of {BATCH} decisions", batched, "decisions/s"),
            row("processor time of a decision in a batch", 1e3 * median(cpu["batch"]) / BATCH, "µs"),
            row(f"{MANY} decisions in a request", median(many), "s"),
            row("slowest single decision beside them", median(beside), "ms"),
        ],
        "goals": [
            at_least("decisions and outcomes per second", PAIRS, median(rates["pairs"])),
            at_least("decisions and outcomes / bare route that commits what waits", SHARE, of_group),
            at_most("processor time of a pair, ms", CPU_MS, median(cpu["pairs"])),
            at_most("99th percentile of a request, ms", P99_MS, median(p99["pairs"])),
            at_least("decisions of batches per second", BATCHED, batched),
            at_most(f"{MANY} decisions, s", SECONDS_OF_MANY, median(many)),
            at_most("slowest single decision beside them, ms", BESIDE_MS, median(beside)),
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


def _bare(path: str) -> SCENARIO:
    async def pairs(connection: Connection, number: int) -> AsyncIterator[None]:
        while True:
            await connection.post(path, {"user": f"user {number}"})
            await connection.post(path, {"decision": f"user {number}", "outcome": 1.0})
            yield

    return pairs


async def _pairs(connection: Connection, number: int) -> AsyncIterator[None]:
    for n in itertools.count():
        answer = await connection.post("/v1/studies/bench/decisions", {"user": f"user {number} {n % 50}"})
        made = json.loads(answer)
        ended = {"decision": made["decision"], "outcome": float(n % 10)}
        await connection.post("/v1/studies/bench/outcomes", ended)
        yield


async def _batches(connection: Connection, number: int) -> AsyncIterator[None]:
    items = [{"user": f"user {number} {place}"} for place in range(BATCH)]
    while True:
        await connection.post("/v1/studies/bench/decisions/batch", {"items": items})
        yield


async def _many_and_a_single(port: int, number: int) -> tuple[float, float]:
    """Seconds of a request with `MANY` decisions, and milliseconds of the slowest single decision beside it."""
    large, small = [Connection(*await asyncio.open_connection("127.0.0.1", port)) for _ in range(2)]
    items = [{"user": f"many {number} {place}"} for place in range(MANY)]
    asked = asyncio.ensure_future(large.post("/v1/studies/bench/decisions/batch", {"items": items}))
    await asyncio.sleep(0.01)
    while not asked.done():
        await small.post("/v1/studies/bench/decisions", {"user": "ada"})
    await asked
    seconds, slowest = large.seconds[-1], 1e3 * max(small.seconds, default=0.0)
    large.close()
    small.close()
    return seconds, slowest
