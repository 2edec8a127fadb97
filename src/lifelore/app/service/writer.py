"""The thread that stores: requests that wait at the same moment share a transaction of memory.

SQLite has one writer at a time, and each transaction waits for the disk. A request is answered after the
transaction that holds it has been committed. Decisions and outcomes of a study that wait together are one batch,
so that many users cost little more than one.
"""

import asyncio
import queue
import threading
from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from lifelore.agent.personalise.decisions import Request, decide, observe
from lifelore.agent.personalise.open_studies import OpenStudies
from lifelore.app.service.telemetry import Metrics
from lifelore.core.errors import LifeloreError
from lifelore.memory import Memory

MOST = 256
"""Largest number of requests in a transaction; more let each of them wait longer."""
PATIENCE = 0.001
"""Seconds to wait for another request where the last transaction had several; a commit takes about as long."""
PART = 500
"""Rows of a long batch that are stored at a time, between which other requests get their turn."""


class _Job(NamedTuple):
    """A function to run, or rows of a study: `kind` is then "decisions" or "outcomes" and `function` None."""

    function: Callable[..., Any] | None
    arguments: tuple[Any, ...]
    loop: asyncio.AbstractEventLoop
    future: asyncio.Future[Any]
    kind: tuple[str, str, bool] = ("", "", False)


class Writer:
    """A thread that stores in a memory, in the order of the requests.

    Parameters
    ----------
    memory : Memory
    studies : OpenStudies
    metrics : Metrics
        Counts what was stored.
    undone : callable
        Called after a transaction that memory refused: what main memory holds of it must be read again.
    seed : int
        Draws the choices.
    """

    def __init__(
        self, memory: Memory, studies: OpenStudies, metrics: Metrics, undone: Callable[[], None], seed: int
    ) -> None:
        self._memory, self._studies, self._metrics, self._undone = memory, studies, metrics, undone
        self._seed = seed
        self._jobs: queue.SimpleQueue[_Job | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._work, name="lifelore writer", daemon=True)
        self._thread.start()

    async def run(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """The result of a function, once all that it stored is committed; its errors as it raised them."""
        loop = asyncio.get_running_loop()
        job = _Job(function, arguments, loop, loop.create_future())
        self._jobs.put(job)
        return await job.future

    async def decide(self, study: str, requests: Sequence[Request], *, brief: bool = False) -> list[Any]:
        """The answers of `decisions.decide`, once the decisions are committed; a long batch in parts."""
        return await self._rows("decisions", study, requests, brief)

    async def observe(
        self, study: str, outcomes: Sequence[tuple[str, float]], *, brief: bool = False
    ) -> list[Any]:
        """The answers of `decisions.observe`, once the outcomes are committed; a long batch in parts."""
        return await self._rows("outcomes", study, outcomes, brief)

    async def _rows(self, kind: str, study: str, rows: Sequence[Any], brief: bool) -> list[Any]:
        loop, answers = asyncio.get_running_loop(), []
        for at in range(0, len(rows), PART):
            job = _Job(None, tuple(rows[at : at + PART]), loop, loop.create_future(), (kind, study, brief))
            self._jobs.put(job)
            answers += await job.future
        return answers

    def stop(self) -> None:
        """Finish the waiting requests and end the thread."""
        self._jobs.put(None)
        self._thread.join()

    def _work(self) -> None:
        patience = 0.0
        while (first := self._jobs.get()) is not None:
            jobs, last, n_rows = [first], False, len(first.arguments)
            while len(jobs) < MOST and n_rows < PART and not last:
                try:
                    following = self._jobs.get(timeout=patience) if patience else self._jobs.get_nowait()
                except queue.Empty:
                    break
                last = following is None
                if following is not None:
                    jobs.append(following)
                    n_rows += len(following.arguments)
            patience = PATIENCE if len(jobs) > 1 else 0.0
            of_rows = [job for job in jobs if job.function is None]
            others = [job for job in jobs if job.function is not None]
            for group, rows in ((of_rows, True), (others, False)):
                if group:
                    _deliver(group, self._results(group, rows))
            if last:
                return

    def _results(self, jobs: Sequence[_Job], rows: bool) -> list[Any]:
        """The result of each job or its error, from one transaction."""
        try:
            with self._memory.together(rows=rows):
                results = self._stored(jobs) if rows else [_result(job) for job in jobs]
        except Exception as error:
            self._undone()
            return [error] * len(jobs)
        if rows:
            self._count(jobs, results)
        return results

    def _stored(self, jobs: Sequence[_Job]) -> list[Any]:
        """Store the rows of jobs, those of a study and a kind as one batch."""
        results: list[Any] = [None] * len(jobs)
        for kind in dict.fromkeys(job.kind for job in jobs):
            own = [place for place, job in enumerate(jobs) if job.kind == kind]
            rows = [row for place in own for row in jobs[place].arguments]
            try:
                answers = self._answers(*kind, rows)
            except LifeloreError as error:
                answers = [error] * len(rows)
            at = 0
            for place in own:
                n = len(jobs[place].arguments)
                results[place] = answers[at : at + n]
                at += n
        return results

    def _answers(self, kind: str, study: str, brief: bool, rows: list[Any]) -> list[Any]:
        opened = self._studies.get(study)
        if kind == "decisions":
            return decide(self._memory, opened, rows, seed=self._seed, brief=brief)
        return observe(self._memory, opened, rows, brief=brief)

    def _count(self, jobs: Sequence[_Job], results: Sequence[Any]) -> None:
        decided: Counter[tuple[str, str, bool]] = Counter()
        taken: dict[tuple[str, str, bool], list[float]] = {}
        for job, answers in zip(jobs, results, strict=True):
            kind, study, _ = job.kind
            for row, answer in zip(job.arguments, answers, strict=True):
                if isinstance(answer, LifeloreError):
                    continue
                if kind == "decisions" and not answer["repeated"]:
                    decided[study, answer["policy"], answer["control"]] += 1
                elif kind == "outcomes" and answer["taken"]:
                    taken.setdefault((study, answer["policy"], answer["control"]), []).append(row[1])
        for (study, policy, control), n in decided.items():
            self._metrics.decided(study, policy, control, n)
        for (study, policy, control), outcomes in taken.items():
            self._metrics.observed(study, policy, sum(outcomes), len(outcomes), control=control)


def _result(job: _Job) -> Any:
    assert job.function is not None
    try:
        return job.function(*job.arguments)
    except Exception as error:
        return error


def _deliver(jobs: Sequence[_Job], results: Sequence[Any]) -> None:
    """Answer all jobs of a transaction by one call of their event loop."""

    def answer() -> None:
        for job, result in zip(jobs, results, strict=True):
            if job.future.done():
                continue
            if isinstance(result, Exception):
                job.future.set_exception(result)
            else:
                job.future.set_result(result)

    jobs[0].loop.call_soon_threadsafe(answer)
