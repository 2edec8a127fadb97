"""Cells in processes of this machine: the same bits as in one, and one line where a process dies."""

import os
import signal
from pathlib import Path

import pytest

from lifelore.core.errors import InputError
from reproduction.engine.provenance import source_key
from reproduction.engine.registry import claim_of
from reproduction.engine.reproduce import reproduce
from reproduction.engine.run_cells import run_on_worker

SMALL = {"mazes": 500, "tasks": 5}
"""Ten cells of some 0.1 s."""


def processes_of_cells() -> list[int]:
    """Process ids of the workers that this process has started."""
    children = Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()
    return [int(child) for child in children if b"popen_loky" in Path(f"/proc/{child}/cmdline").read_bytes()]


def test_processes_give_the_bits_of_one(tmp_path):
    one = reproduce(["C3.1"], "full", SMALL, jobs=1, out=tmp_path / "one")
    calls = []
    two = reproduce(
        ["C3.1"], "full", SMALL, jobs=2, out=tmp_path / "two", progress=lambda *call: calls.append(call)
    )
    assert processes_of_cells()
    assert [done for done, _, _ in calls] == list(range(calls[-1][1] + 1))
    assert {**one[0], "seconds": 0} == {**two[0], "seconds": 0}


def test_a_process_that_dies_is_one_line_and_what_is_finished_is_kept(tmp_path):
    ended = []

    def kill(done: int, total: int, label: str) -> None:
        ended.append(done)
        if done == 1:
            for worker in processes_of_cells():
                os.kill(worker, signal.SIGKILL)

    with pytest.raises(InputError, match=r"died, perhaps for want of memory; .* fewer than 2"):
        reproduce(["C3.1"], "full", SMALL, jobs=2, out=tmp_path, progress=kill)
    first = []
    reproduce(["C3.1"], "full", SMALL, jobs=1, out=tmp_path, progress=lambda *call: first.append(call[0]))
    assert first[0] == ended[-1] >= 1


def test_a_worker_with_other_code_refuses():
    claim = claim_of("C3.1")
    settings = claim.settings("quick", SMALL)
    cell = claim.cells(settings)[0]
    place, result, seconds = run_on_worker(3, "C3.1", settings, cell, 0, source_key())
    assert (place, result) == (3, claim.run_cell(settings, cell, 0))
    assert seconds > 0
    with pytest.raises(InputError, match=r"has other code of C3\.1"):
        run_on_worker(3, "C3.1", settings, cell, 0, "other")
