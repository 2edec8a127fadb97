"""`bench soak`: minutes of load on a service whose memory has many users; does its main memory grow, is it slower?

The store is filled with a decision for each user before the service starts. Then every connection takes users at
random, gets a decision and gives its outcome. The same load on an empty store is measured before and after.
"""

import asyncio
import time
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np

from benchmarks.rounds import at_most, row
from benchmarks.service.load_client import SCENARIO, Connection, run_load
from benchmarks.service.server_process import (
    STUDY,
    Server,
    pinned_client,
    processor_seconds,
    resident_megabytes,
    service,
)
from lifelore.agent.personalise.library_document import library_of
from lifelore.agent.personalise.registration import StudySettings, register
from lifelore.agent.reuse.one_user import choose
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.memory import open_memory

USERS_A_MINUTE = 100_000
"""Users in the store for each minute of load."""
CONNECTIONS = 32
SECONDS = 10.0
"""Of a piece of load, after which the process is measured; six make a minute."""
WARM_UP = 0.2
"""Share of the time whose growth does not count: caches fill."""
FILLED_TOGETHER = 1000
"""Users in a transaction while the store is filled."""
GROWTH, SLOWER = 1.0, 1.25
"""Goals: megabytes a minute, and processor time of a pair beside that on an empty store."""


class _Piece(NamedTuple):
    """Pairs, processor milliseconds of the server for each, 99th percentile of a request, and resident memory."""

    pairs: float
    cpu_ms: float
    p99_ms: float
    megabytes: float


def bench_soak(repeats: int, progress: Progress) -> dict[str, Any]:
    """Rows and goals; see `benchmarks.bench`. A round is a minute."""
    users, pieces = USERS_A_MINUTE * repeats, 6 * repeats
    total = -(-users // FILLED_TOGETHER) + pieces + 2
    done = 0

    def step(label: str) -> None:
        nonlocal done
        done += 1
        progress(done, total, label)

    with TemporaryDirectory() as folder, pinned_client() as core:
        large, empty = Path(folder) / "large.db", Path(folder) / "empty.db"
        _fill(empty, 0, step)
        began = time.process_time()
        _fill(large, users, step)
        filled = time.process_time() - began
        with service(empty, core) as small, service(large, core) as ours:
            first = [_loaded(small, users, 0), _loaded(ours, users, 1)]
            step("load")
            found = []
            for number in range(pieces):
                found.append(_loaded(ours, users, number + 2))
                step("load")
            last = _loaded(small, users, pieces + 2)
            step("load")
        size = sum(path.stat().st_size for path in Path(folder).glob("large.db*"))
    late = found[int(WARM_UP * len(found)) :]
    growth = _slope([piece.megabytes for piece in late])
    cpu = median(piece.cpu_ms for piece in found)
    on_empty = median([first[0].cpu_ms, last.cpu_ms])
    return {
        "rows": [
            row("users in the store", float(users), "users"),
            row("processor time to fill it, a user", 1e3 * filled / users, "ms"),
            row("file, a user", size / users, "bytes"),
            row("load", SECONDS * len(found) / 60, "minutes"),
            row("pairs of decision and outcome", sum(piece.pairs for piece in found), "pairs"),
            row("rate", median(piece.pairs for piece in found) / SECONDS, "pairs/s"),
            row("99th percentile of a request", median(piece.p99_ms for piece in found), "ms"),
            row("empty store: processor time of a pair", on_empty, "ms"),
            row("processor time of a pair", cpu, "ms", "empty store: processor time of a pair", cpu / on_empty),
            row("resident memory of the service at the end", found[-1].megabytes, "MB"),
            row("its growth after the warm-up", growth, "MB/min"),
        ],
        "goals": [
            at_most("growth of resident memory, MB a minute", GROWTH, growth),
            at_most("processor time of a pair, beside an empty store", SLOWER, cpu / on_empty),
        ],
    }


def _fill(path: Path, users: int, step: Callable[[str], None]) -> None:
    """A store with the study and a decision for each user."""
    settings = StudySettings(rule=STUDY["rule"], control=STUDY["control"])
    with open_memory(path) as memory:
        study = register(memory, "bench", library_of(STUDY["library"]), settings)
        for start in range(0, users, FILLED_TOGETHER):
            with memory.together():
                for number in range(start, min(start + FILLED_TOGETHER, users)):
                    choose(memory, study, f"user {number}")
            step("users")


def _loaded(server: Server, users: int, number: int) -> _Piece:
    began = processor_seconds(server.process)
    pairs, requests = asyncio.run(run_load(server.port, _random_users(users, number), CONNECTIONS, SECONDS))
    spent = processor_seconds(server.process) - began
    made = pairs * SECONDS
    p99 = 1e3 * float(np.quantile(requests, 0.99))
    return _Piece(made, 1e3 * spent / made, p99, resident_megabytes(server.process))


def _random_users(users: int, number: int) -> SCENARIO:
    async def pairs(connection: Connection, place: int) -> AsyncIterator[None]:
        rng = stream(0, "soak", number, place)
        while True:
            user = f"user {rng.integers(users)}"
            made = await connection.post("/v1/studies/bench/decisions", {"user": user})
            ended = {"decision": made["decision"], "outcome": float(rng.integers(10))}
            await connection.post("/v1/studies/bench/outcomes", ended)
            yield

    return pairs


def _slope(megabytes: list[float]) -> float:
    """Megabytes a minute, by least squares."""
    if len(megabytes) < 2:
        return 0.0
    minutes = np.arange(len(megabytes)) * SECONDS / 60
    return float(np.polyfit(minutes, megabytes, 1)[0])
