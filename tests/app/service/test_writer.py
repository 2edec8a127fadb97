"""The writer: one transaction for requests that wait together, and an answer only after it."""

import asyncio
import threading

import numpy as np
import pytest

from lifelore.agent.personalise.decisions import Request, decide
from lifelore.agent.personalise.open_studies import OpenStudies
from lifelore.agent.personalise.registration import register
from lifelore.app.service import writer as module
from lifelore.app.service.telemetry import Metrics
from lifelore.app.service.writer import PART, Writer
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.core.protocols import Record
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.memory import open_memory


@pytest.fixture
def memory(tmp_path):
    with open_memory(tmp_path / "lifelore.db") as opened:
        yield opened


def a_writer(memory, undone):
    return Writer(memory, OpenStudies(memory), Metrics(), lambda: undone.append(1), seed=0)


def contribute(memory, number):
    if number == 3:
        raise InputError("number must not be 3")
    record = Record("action_prior", "k", 1, "add", slots=np.array([1]), values=np.array([1]))
    return memory.contribute(f"robot {number}", [record], process="p", seq=0, task={})


def test_requests_that_wait_together_share_a_transaction(memory, monkeypatch):
    undone, blocks, gate = [], [], threading.Event()
    together = memory.together
    monkeypatch.setattr(memory, "together", lambda **rows: blocks.append(1) or together(**rows))
    writer = a_writer(memory, undone)

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

    def refused(**rows):
        class Refused:
            def __enter__(self):
                self.block = together(**rows)
                return self.block.__enter__()

            def __exit__(self, *error):
                full = StoreError("no space is left")
                self.block.__exit__(StoreError, full, None)
                raise full

        return Refused()

    monkeypatch.setattr(memory, "together", refused)
    writer = a_writer(memory, undone)
    with pytest.raises(StoreError, match="no space"):
        asyncio.run(writer.run(contribute, memory, 0))
    writer.stop()
    assert undone == [1]
    assert memory.robots() == []


def test_rows_that_wait_together_are_one_batch_and_parts_of_a_long_one_give_way(memory, monkeypatch):
    register(memory, "s", PolicyLibrary.from_means([[1.0, 0.0], [0.0, 1.0]], 1.0))
    batches, undone = [], []
    monkeypatch.setattr(
        module, "decide", lambda *given, **how: batches.append(len(given[2])) or decide(*given, **how)
    )
    writer, gate = a_writer(memory, undone), threading.Event()

    async def in_parts():
        users = [Request(f"u{n}") for n in range(2 * PART)]
        parts = [await writer.decide("s", users[at : at + PART], brief=True) for at in (0, PART)]
        return parts[0] + parts[1]

    async def ask():
        first = asyncio.ensure_future(writer.run(gate.wait))
        await asyncio.sleep(0.05)
        many = asyncio.ensure_future(in_parts())
        single = [asyncio.ensure_future(writer.decide("s", [Request(f"v{n}")])) for n in range(3)]
        unknown = asyncio.ensure_future(writer.decide("t", [Request("ada")]))
        await asyncio.sleep(0.05)
        gate.set()
        return await asyncio.gather(first, many, *single, unknown)

    _, many, *single, unknown = asyncio.run(ask())
    writer.stop()
    # The first part, then those who came meanwhile, then the second part.
    assert batches == [PART, 3, PART]
    assert len({answer["decision"] for answer in many}) == 2 * PART
    assert [answer["user"] for (answer,) in single] == ["v0", "v1", "v2"]
    assert isinstance(unknown[0], NotFoundError)
    assert undone == []
