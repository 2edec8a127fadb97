"""After a loss of power at any write a memory opens, is sound, and has what it had acknowledged."""

import itertools
import shutil
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from lifelore.core import Record, stream
from lifelore.memory import Memory, open_memory, store
from lifelore.memory.study_rows import DecisionRow
from tests.memory.power_loss import Disk, Driver

_NUMBERS = itertools.count()


class Loss(NamedTuple):
    """What a loss of power has left, and what the memory had acknowledged by then.

    path : of the memory
    tasks, outcomes : numbers of the stored tasks and outcomes
    begun : number of the task or outcome that the memory was storing
    """

    path: Path
    tasks: frozenset[int]
    outcomes: frozenset[int]
    begun: int

    def check(self, *, durable: bool) -> None:
        """Open the memory and compare it with what it had acknowledged."""
        with open_memory(self.path) as memory:
            assert memory.check() == []
            tasks, outcomes = {one["number"] for one in memory.task_descriptions("robot")}, _outcomes(memory)
            assert tasks <= {*self.tasks, self.begun}
            assert outcomes <= {*self.outcomes, self.begun}
            # Without `durable` the last ones may be lost, and none before one that is there.
            safe = range(self.begun) if durable else range(max(tasks | outcomes, default=-1))
            assert self.tasks & set(safe) <= tasks
            assert self.outcomes & set(safe) <= outcomes
            assert memory.contribute("robot", [_record(np.arange(3))], process="after", seq=0, task={"number": 99})


def _record(slots: np.ndarray) -> Record:
    return Record("counts", "shared", 1, "add", slots, np.ones(len(slots), np.int64))


def _outcomes(memory: Memory) -> set[int]:
    version = memory.studies.newest("shop")
    if version is None:
        return set()
    with memory.studies.reading(version.number) as rows:
        found = rows.decisions([number.to_bytes(16, "big") for number in range(100)]).values()
    assert all(row.outcome is not None for row in found)  # a decision and its outcome are one transaction here
    return {int(row.outcome) for row in found if row.outcome is not None}


def losses_of_a_life(
    folder: Path, patch: pytest.MonkeyPatch, rng: np.random.Generator, *, share: float, durable: bool
) -> list[Loss]:
    """Store tasks and outcomes in a random order on a disk whose power fails at a share of the writes."""
    disk, losses = Disk(f"disk{next(_NUMBERS)}"), list[Loss]()
    tasks, outcomes, begun = set[int](), set[int](), -1

    def maybe_fail() -> None:
        if rng.random() < share:
            place = folder / f"loss{len(losses)}"
            disk.lose_power(place, rng)
            losses.append(Loss(place / "m.db", frozenset(tasks), frozenset(outcomes), begun))

    disk.at_change = maybe_fail
    patch.setattr(store, "connect", lambda path, access: Driver(path, disk))
    with open_memory(folder / "m.db", durable=durable) as memory:
        study = memory.studies.keep("shop", {"rule": "greedy"}, b"library").number
        with memory.studies.writing(study) as rows:
            rows.add_users([("ann", None, None)], 1)
            user = rows.users(["ann"])["ann"].number
        for begun in range(rng.integers(3, 12)):
            if rng.random() < 0.5:
                slots = np.sort(rng.choice(10**6, rng.integers(1, 2000), replace=False))
                memory.contribute("robot", [_record(slots)], process="p", seq=begun, task={"number": begun})
                tasks.add(begun)
            else:
                name = begun.to_bytes(16, "big")
                with memory.studies.writing(study) as rows:
                    rows.add_decisions([DecisionRow(name, user, "a", 0.5, False, 1, begun)])
                    rows.end_decisions([(name, float(begun), begun)])
                outcomes.add(begun)
    return losses


def check_lives(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, lives: int, share: float, *, durable: bool
) -> int:
    """Check each loss of power in some lives; their number."""
    checked = 0
    for number in range(lives):
        folder = tmp_path / str(number)
        folder.mkdir()
        with monkeypatch.context() as patch:
            losses = losses_of_a_life(folder, patch, stream(number, "power"), share=share, durable=durable)
        for loss in losses:
            loss.check(durable=durable)
        checked += len(losses)
        shutil.rmtree(folder)
    return checked


@pytest.mark.parametrize("durable", [True, False])
def test_a_loss_of_power_loses_nothing_acknowledged(tmp_path, monkeypatch, durable):
    assert check_lives(tmp_path, monkeypatch, 4, 0.1, durable=durable) > 20


@pytest.mark.soak
@pytest.mark.parametrize("durable", [True, False])
def test_soak_every_write_of_200_lives(tmp_path, monkeypatch, durable):
    assert check_lives(tmp_path, monkeypatch, 200, 1.0, durable=durable) > 10_000
