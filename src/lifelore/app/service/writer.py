"""The thread that stores: requests that wait at the same moment share a transaction of memory.

SQLite has one writer at a time, and each transaction waits for the disk. A request is answered after the
transaction that holds it has been committed. Decisions and outcomes of a study that wait together are one batch,
so that many users cost little more than one.
"""

import asyncio
import queue
import threading
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import islice
from typing import Any, Literal, NamedTuple

from lifelore.agent.personalise.decisions import decide, observe
from lifelore.app.service.study_watch import OpenStudies
from lifelore.app.service.telemetry import Metrics
from lifelore.core.errors import LifeloreError
from lifelore.memory import Memory

MOST = 256
"""Largest number of requests in a transaction; more let each of them wait longer."""
PATIENCE = 0.001
"""Seconds to wait for another request where the last transaction had several; a commit takes about as long."""
WHOLE, PART = 1000, 500
"""Rows of the longest batch that is stored at once, and rows of a longer one that are stored at a time, between
which other requests get their turn; more let these wait longer, fewer wait for the disk more often."""


Kind = Literal["decisions", "outcomes"]


class _Job(NamedTuple):
    """Rows of a study to store.

    kind : decisions or outcomes, the study, and whether answers are brief
    """

    kind: tuple[Kind, str, bool]
    rows: Sequence[Any]
    future: asyncio.Future[Any]


class Writer:
    """A thread that stores in a memory, in the order of the requests.

    Parameters
    ----------
    memory : Memory
    studies : OpenStudies
    metrics : Metrics
        Counts what was stored.
    seed : int
        Draws the choices.
    """

    def __init__(self, memory: Memory, studies: OpenStudies, metrics: Metrics, seed: int) -> None:
        self._memory, self._studies, self._metrics, self._seed = memory, studies, metrics, seed
        self._jobs: queue.SimpleQueue[_Job | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._work, name="lifelore writer", daemon=True)
        self._thread.start()

    def store(
        self, kind: Kind, study: str, rows: Sequence[Any], *, brief: bool = False
    ) -> asyncio.Future[list[Any]]:
        """The answers of `decisions.decide` or `decisions.observe` to these rows, once they are committed."""
        job = _Job((kind, study, brief), rows, asyncio.get_running_loop().create_future())
        self._jobs.put(job)
        return job.future

    def stop(self) -> None:
        """Finish the waiting requests and end the thread."""
        self._jobs.put(None)
        self._thread.join()

    def _work(self) -> None:
        patience = 0.0
        while (first := self._jobs.get()) is not None:
            jobs, n_rows, last = [first], len(first.rows), False
            while len(jobs) < MOST and n_rows < PART and not last:
                try:
                    following = self._jobs.get(timeout=patience) if patience else self._jobs.get_nowait()
                except queue.Empty:
                    break
                if following is None:
                    last = True
                else:
                    jobs.append(following)
                    n_rows += len(following.rows)
            patience = PATIENCE if len(jobs) > 1 else 0.0
            _deliver(jobs, self._results(jobs))
            if last:
                return

    def _results(self, jobs: Sequence[_Job]) -> list[Any]:
        """The answers to each job or its error, from one transaction."""
        try:
            with self._memory.together(rows=True):
                results = self._stored(jobs)
        except Exception as error:
            self._studies.drop_all()  # they may hold what was undone
            return [error] * len(jobs)
        self._count(jobs, results)
        return results

    def _stored(self, jobs: Sequence[_Job]) -> list[Any]:
        """Store the rows of jobs, those of a study and a kind as one batch."""
        answers: dict[Any, Iterator[Any]] = {}
        for kind in dict.fromkeys(job.kind for job in jobs):
            rows = [row for job in jobs if job.kind == kind for row in job.rows]
            answers[kind] = iter(self._answers(*kind, rows))
        return [list(islice(answers[job.kind], len(job.rows))) for job in jobs]

    def _answers(self, kind: str, study: str, brief: bool, rows: list[Any]) -> list[Any]:
        try:
            opened = self._studies.get(study)
            if kind == "decisions":
                return decide(self._memory, opened, rows, seed=self._seed, brief=brief)
            return observe(self._memory, opened, rows, brief=brief)
        except LifeloreError as error:
            return [error] * len(rows)

    def _count(self, jobs: Sequence[_Job], results: Sequence[Any]) -> None:
        """Count new decisions and outcomes, by arm and not by row."""
        decided = Counter[tuple[str, str, bool]]()
        observed: dict[tuple[str, str, bool], list[float]] = {}
        for job, answers in zip(jobs, results, strict=True):
            kind, study, _ = job.kind
            new = [(one, row) for one, row in zip(answers, job.rows, strict=True) if _is_new(one)]
            if kind == "decisions":
                decided.update([(study, one["policy"], one["control"]) for one, _ in new])
            else:
                for one, (_, outcome) in new:
                    observed.setdefault((study, one["policy"], one["control"]), []).append(outcome)
        for arm, n in decided.items():
            self._metrics.decided(*arm, n)
        for arm, outcomes in observed.items():
            self._metrics.observed(*arm, len(outcomes), sum(outcomes))


def _is_new(answer: Any) -> bool:
    """Whether an answer is of a decision or outcome that was stored now."""
    return not isinstance(answer, LifeloreError) and answer.get("taken", not answer.get("repeated"))


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

    jobs[0].future.get_loop().call_soon_threadsafe(answer)
