"""The writer: one transaction for requests that wait together, and an answer only after it."""

import asyncio
import threading

import pytest

from lifelore.agent.personalise.decisions import Request, decide
from lifelore.agent.personalise.registration import register
from lifelore.app.service import writer as module
from lifelore.app.service.study_watch import OpenStudies
from lifelore.app.service.telemetry import Metrics
from lifelore.app.service.writer import PART, Writer
from lifelore.core.errors import NotFoundError, StoreError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.memory import open_memory


@pytest.fixture
def memory(tmp_path):
    with open_memory(tmp_path / "lifelore.db") as opened:
        register(opened, "s", PolicyLibrary.from_means([[1.0, 0.0], [0.0, 1.0]], 1.0))
        yield opened


def a_writer(memory):
    return Writer(memory, OpenStudies(memory), Metrics(), seed=0)


async def stored(writer, *requests):
    return await writer.store("decisions", "s", requests)


def n_decisions(memory):
    with memory.studies.totals(memory.studies.newest("s").number) as totals:
        return totals.n_decisions()[0]


def test_a_refused_transaction_answers_nobody_with_success(memory, monkeypatch):
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

    writer = a_writer(memory)
    monkeypatch.setattr(memory, "together", refused)
    with pytest.raises(StoreError, match="no space"):
        asyncio.run(stored(writer, Request("ada")))
    monkeypatch.undo()
    assert n_decisions(memory) == 0
    assert asyncio.run(stored(writer, Request("ada")))[0]["user"] == "ada"
    writer.stop()
    assert n_decisions(memory) == 1


def test_rows_that_wait_together_are_one_batch_and_parts_of_a_long_one_give_way(memory, monkeypatch):
    batches, blocks, gate = [], [], threading.Event()
    together = memory.together

    def counted(*given, **how):
        batches.append(len(given[2]))
        assert gate.wait(60)
        return decide(*given, **how)

    monkeypatch.setattr(module, "decide", counted)
    monkeypatch.setattr(memory, "together", lambda **rows: blocks.append(1) or together(**rows))
    writer = a_writer(memory)

    async def in_parts():
        users = [Request(f"u{n}") for n in range(2 * PART)]
        parts = [await writer.store("decisions", "s", users[at : at + PART], brief=True) for at in (0, PART)]
        return parts[0] + parts[1]

    async def ask():
        first = asyncio.ensure_future(writer.store("decisions", "s", [Request("ada")]))
        await asyncio.sleep(0.05)
        many = asyncio.ensure_future(in_parts())
        await asyncio.sleep(0)
        single = [asyncio.ensure_future(writer.store("decisions", "s", [Request(f"v{n}")])) for n in range(3)]
        unknown = asyncio.ensure_future(writer.store("decisions", "t", [Request("ada")]))
        await asyncio.sleep(0.05)
        gate.set()
        return await asyncio.gather(first, many, *single, unknown)

    _, many, *single, unknown = asyncio.run(ask())
    writer.stop()
    # The first part, then those who came meanwhile, then the second part.
    assert batches == [1, PART, 3, PART]
    assert len(blocks) <= 4
    assert len({answer["decision"] for answer in many}) == 2 * PART
    assert [answer["user"] for (answer,) in single] == ["v0", "v1", "v2"]
    assert isinstance(unknown[0], NotFoundError)
