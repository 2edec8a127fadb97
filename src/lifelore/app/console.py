"""How the command line speaks: progress to a terminal's stderr, one JSON document or tables to stdout."""

import json
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lifelore.core.protocols import Progress

INTERRUPTED = 130
"""Exit status after Ctrl-C, as shells have it."""


def print_json(document: Any) -> None:
    """One whole JSON document on stdout; NaN and infinity are refused rather than written as invalid JSON."""
    print(json.dumps(document, indent=2, allow_nan=False))


def print_json_line(document: Any) -> None:
    """One JSON document in one line of stdout, at once: a stream that can be read while it grows."""
    print(json.dumps(document, allow_nan=False), flush=True)


@contextmanager
def progress_bar(what: str) -> "Iterator[Progress | None]":
    """A callback ``(done, total, label)`` that draws a bar on stderr; None where stderr is no terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        line = bar.add_task(what, total=None)

        def show(done: int, total: int, label: str) -> None:
            bar.update(line, completed=done, total=total, description=f"{what}: {label}")

        yield show


@contextmanager
def stop_on_interrupt() -> Iterator[Event]:
    """An event that the first Ctrl-C sets; the second one interrupts at once."""
    stop = Event()

    def interrupted(number, frame) -> None:
        if stop.is_set():
            raise KeyboardInterrupt
        stop.set()
        print("stopping: keeping what is finished (Ctrl-C again to leave at once)", file=sys.stderr)

    before = signal.signal(signal.SIGINT, interrupted)
    try:
        yield stop
    finally:
        signal.signal(signal.SIGINT, before)
