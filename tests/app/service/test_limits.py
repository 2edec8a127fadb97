"""Deadlines of requests: a late one is cancelled, a long answer in pieces is not, and one timer serves all."""

import asyncio

from lifelore.app.service.limits import Deadlines


def ends(seconds: list[float], limit: float) -> list[bool]:
    """Whether tasks that take so many seconds are cancelled for their time."""
    deadlines = Deadlines(limit)

    async def one(time: float) -> bool:
        task = deadlines.begin()
        try:
            await asyncio.sleep(time)
        except asyncio.CancelledError:
            assert deadlines.end(task)
            assert task.cancelling() == 0
            return True
        return deadlines.end(task)

    async def all_of_them() -> list[bool]:
        return await asyncio.gather(*map(one, seconds))

    found = asyncio.run(all_of_them())
    assert deadlines.running == 0
    assert asyncio.run(all_of_them()) == found, "in another event loop too"
    return found


def test_late_tasks_alone_are_cancelled():
    assert ends([0.0, 30.0, 0.01, 30.0], 0.3) == [False, True, False, True]


def test_a_task_that_was_cancelled_by_others_is_not_late():
    async def late() -> bool:
        deadlines = Deadlines(30.0)

        async def one() -> bool:
            task = deadlines.begin()
            try:
                await asyncio.sleep(30.0)
            except asyncio.CancelledError:
                return deadlines.end(task)
            return False

        task = asyncio.ensure_future(one())
        await asyncio.sleep(0.01)
        task.cancel()
        return await task

    assert not asyncio.run(late())
