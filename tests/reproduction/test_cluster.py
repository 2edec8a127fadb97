"""Claims on a real dask cluster (extra cluster): the same bits as here, also where a worker is killed."""

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator

import pytest

from lifelore.core.errors import InputError, MissingExtraError
from reproduction.engine import run_cells
from reproduction.engine.reproduce import reproduce

CLAIM = "C3.1"
SMALL = {"mazes": 500, "tasks": 5}


def wait_for(process: subprocess.Popen[str], pattern: str) -> str:
    for line in process.stderr:
        if found := re.search(pattern, line):
            return found[0]
    raise AssertionError(f"{process.args} ended without {pattern}")


@pytest.fixture(scope="module")
def scheduler() -> Iterator[str]:
    """The address of a scheduler of our own, without workers."""
    pytest.importorskip("distributed", reason="needs the extra cluster")
    process = subprocess.Popen(
        [sys.executable, "-c", "from distributed.cli.dask_scheduler import main; main()",
         "--host", "127.0.0.1", "--port", "0", "--no-dashboard"],
        stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    with process:
        yield wait_for(process, r"tcp://127\.0\.0\.1:\d+")
        process.kill()


def worker(scheduler: str) -> subprocess.Popen[str]:
    process = subprocess.Popen(
        [sys.executable, "-c", "from distributed.cli.dask_worker import main; main()",
         scheduler, "--nthreads", "1", "--no-dashboard", "--no-nanny"],
        stderr=subprocess.PIPE, text=True, env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
    )  # fmt: skip
    wait_for(process, "Starting established connection")
    return process


def without_seconds(results: list[dict]) -> str:
    return json.dumps([{name: value for name, value in result.items() if name != "seconds"} for result in results])


def test_a_cluster_without_workers_is_refused(scheduler, tmp_path):
    with pytest.raises(InputError, match="has no workers; start some: dask worker"):
        reproduce([CLAIM], out=tmp_path, scheduler=scheduler)


def test_a_cluster_gives_the_same_bits_also_where_a_worker_is_killed(scheduler, tmp_path):
    here = reproduce([CLAIM], out=tmp_path / "here", overrides=SMALL, jobs=1)
    victim, survivor = worker(scheduler), worker(scheduler)
    killed = []

    def kill(done: int, total: int, label: str) -> None:
        if done >= 1 and not killed:
            killed.append((done, total))
            victim.send_signal(signal.SIGKILL)

    with victim, survivor:
        there = reproduce([CLAIM], out=tmp_path / "there", overrides=SMALL, scheduler=scheduler, progress=kill)
        assert victim.wait() == -signal.SIGKILL
        survivor.kill()
    ((done, total),) = killed
    assert done < total, "the worker was killed while cells were left"
    assert without_seconds(there) == without_seconds(here)
    cells = [(tmp_path / place / CLAIM / "cells").glob("*.json") for place in ("here", "there")]
    ours, theirs = ({path.name: json.loads(path.read_text())["result"] for path in own} for own in cells)
    assert ours == theirs
    assert len(ours) == total


def test_a_scheduler_that_is_not_there(monkeypatch, tmp_path):
    pytest.importorskip("distributed", reason="needs the extra cluster")
    monkeypatch.setattr(run_cells, "SECONDS_TO_CONNECT", 1)
    with pytest.raises(InputError, match=r"scheduler tcp://127\.0\.0\.1:9 cannot be reached"):
        reproduce([CLAIM], out=tmp_path, scheduler="tcp://127.0.0.1:9")


def test_without_distributed_the_extra_is_named(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingExtraError, match=r"lifelore\[cluster\]"):
        reproduce([CLAIM], out=tmp_path, scheduler="tcp://127.0.0.1:9")
