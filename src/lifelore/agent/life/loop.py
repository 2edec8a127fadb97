"""The one loop of a life: task after task is lived and stored in one transaction.

recall what memory holds                                                    `RunningLife.recall`
for each task:
    take a number that no other process of this robot has                   (a lease of memory)
    recall again what other robots and processes have stored                (with `refresh`)
    live the task                                                           `RunningLife.live`
    store its records and its document, and end the lease                   (one transaction)
    report the task                                                         `RunningLife.finish`
    or, if another process has taken it over meanwhile: recall, go on

What is lived in plugs in as a `RunningLife`: buildings and grids, families of tasks with hidden types, and a
user's own worlds.
"""

import os
import uuid
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from threading import Event
from typing import Any, Protocol

from lifelore.core.protocols import Progress, Record
from lifelore.memory import Memory, open_memory


class Stopped(Exception):
    """The user asked to stop; the task in progress is dropped."""


@dataclass(frozen=True, eq=False)
class LivedTask:
    """A task that was lived, and is not stored yet.

    Parameters
    ----------
    records : sequence of Record
        What it taught.
    document : mapping of str to JSON values
        Its description in memory.
    result : object
        What `RunningLife.finish` reports.
    headline : str
        For the progress report, in a few words; may be empty.
    """

    records: Sequence[Record]
    document: Mapping[str, Any]
    result: Any
    headline: str = ""


class RunningLife(Protocol):
    """A life in progress: the knowledge of its agents, and what a task is."""

    def recall(self) -> None:
        """Know what memory holds: before the first task, with ``refresh`` before each, and after a lost one."""
        ...

    def live(self, number: int, seq: int, stop: Event) -> LivedTask:
        """Live task `number`, which is the one number `seq` (from 0) of this run.

        Raises
        ------
        Stopped
            The stop event is set; the task is given back.
        """
        ...

    def finish(self, lived: LivedTask) -> None:
        """Report a task after memory has stored it."""
        ...


def run_life(
    life: RunningLife,
    n_tasks: int,
    *,
    memory: Memory | None,
    robot: str = "robot",
    refresh: bool = False,
    progress: Progress | None = None,
    stop: Event | None = None,
    notify: Callable[[str], None] | None = None,
) -> None:
    """Live through `n_tasks` tasks.

    Parameters
    ----------
    life : RunningLife
    n_tasks : int
    memory : Memory, optional
        Stores each task in one transaction. Without, tasks have the numbers 0, 1, 2, … and nothing is stored.
    robot : str
        Name of the robot in memory.
    refresh : bool
        Whether to recall before each task what other robots and processes have stored.
    progress : callable, optional
        Called as ``progress(done, total, label)`` before the first task and after each.
    stop : threading.Event, optional
        Set it to stop early: the task in progress is finished, or dropped if `life` raises `Stopped`.
    notify : callable, optional
        Called with a line of text if another process has taken a task over.

    Raises
    ------
    StoreError
        Memory cannot store a task, which is given back; earlier tasks stay stored.
    """
    stop = stop or Event()
    process = f"{os.getpid()}-{uuid.uuid4().hex[:12]}"
    life.recall()
    if progress:
        progress(0, n_tasks, "")
    for seq in range(n_tasks):
        if stop.is_set():
            break
        try:
            with nullcontext(seq) if memory is None else memory.taken_task(robot, process=process) as number:
                if refresh and seq and memory is not None:
                    life.recall()
                lived = life.live(number, seq, stop)
                stored = memory is None or memory.contribute(
                    robot, lived.records, process=process, seq=seq, task=lived.document, taken=number
                )
        except Stopped:
            break
        if stored:
            life.finish(lived)
        else:
            life.recall()
            if notify:
                notify(
                    f"task {number} took so long that another process took it over; its result here is not used"
                )
        if progress:
            progress(seq + 1, n_tasks, f"task {number}" + (f": {lived.headline}" if lived.headline else ""))


def opened_memory(where: Memory | str | Path | None) -> AbstractContextManager[Memory | None]:
    """A block with a memory that it opens and closes, or that is open already and stays so; None is no memory."""
    return nullcontext(where) if where is None or isinstance(where, Memory) else open_memory(where)
