"""Output of the command line: progress bars on stderr, JSON documents on stdout, and stopping by Ctrl-C."""

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
"""Exit status after Ctrl-C, as in shells."""


def print_json(document: Any) -> None:
    """Print a JSON document on stdout; raise ValueError for NaN and infinity, which JSON does not have."""
    print(json.dumps(document, indent=2, allow_nan=False))


def print_json_line(document: Any) -> None:
    """Print a JSON document as one line of stdout and flush it, for readers of a stream."""
    print(json.dumps(document, allow_nan=False), flush=True)


@contextmanager
def progress_bar(action: str) -> "Iterator[Progress | None]":
    """A callback ``(done, total, label)`` that draws a bar on stderr; None if stderr is no terminal."""
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
        line = bar.add_task(action, total=None)

        def show(done: int, total: int, label: str) -> None:
            bar.update(line, completed=done, total=total, description=f"{action}: {label}")

        yield show


@contextmanager
def stop_on_interrupt() -> Iterator[Event]:
    """An event that the first Ctrl-C sets; the second Ctrl-C interrupts at once."""
    stop = Event()

    def interrupted(number, frame) -> None:
        if stop.is_set():
            raise KeyboardInterrupt
        stop.set()
        print("stopping: finished work is stored (press Ctrl-C again to quit at once)", file=sys.stderr)

    before = signal.signal(signal.SIGINT, interrupted)
    try:
        yield stop
    finally:
        signal.signal(signal.SIGINT, before)
