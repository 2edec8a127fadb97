"""The writer: one transaction for requests that wait together, and an answer only after it."""

import asyncio
import threading

import numpy as np
import pytest

from lifelore.app.service.writer import Writer
from lifelore.core.errors import InputError, StoreError
from lifelore.core.protocols import Record
from lifelore.memory import open_memory


@pytest.fixture
def memory(tmp_path):
    with open_memory(tmp_path / "lifelore.db") as opened:
        yield opened


def contribute(memory, number):
    if number == 3:
        raise InputError("number must not be 3")
    record = Record("action_prior", "k", 1, "add", slots=np.array([1]), values=np.array([1]))
    return memory.contribute(f"robot {number}", [record], process="p", seq=0, task={})


def test_requests_that_wait_together_share_a_transaction(memory, monkeypatch):
    undone, blocks, gate = [], [], threading.Event()
    together = memory.together
    monkeypatch.setattr(memory, "together", lambda: blocks.append(1) or together())
    writer = Writer(memory, lambda: undone.append(1))

    async def ask():
        first = asyncio.ensure_future(writer.run(gate.wait))
        await asyncio.sleep(0.05)
        others = [asyncio.ensure_future(writer.run(contribute, memory, number)) for number in range(5)]
        await asyncio.sleep(0.05)
        gate.set()
        return await asyncio.gather(first, *others, return_exceptions=True)

    answers = asyncio.run(ask())
    writer.stop()
    assert answers[:4] == [True, True, True, True]
    assert isinstance(answers[4], InputError)
    assert answers[5] is True
    assert (len(blocks), undone) == (2, [])
    assert memory.robots() == [f"robot {number}" for number in (0, 1, 2, 4)]


def test_a_refused_transaction_answers_nobody_with_success(memory, monkeypatch):
    undone = []
    together = memory.together

    def refused():
        class Refused:
            def __enter__(self):
                self.block = together()
                return self.block.__enter__()

            def __exit__(self, *error):
                full = StoreError("no space is left")
                self.block.__exit__(StoreError, full, None)
                raise full

        return Refused()

    monkeypatch.setattr(memory, "together", refused)
    writer = Writer(memory, lambda: undone.append(1))
    with pytest.raises(StoreError, match="no space"):
        asyncio.run(writer.run(contribute, memory, 0))
    writer.stop()
    assert undone == [1]
    assert memory.robots() == []
