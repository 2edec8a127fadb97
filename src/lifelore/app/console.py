"""Output of the command line: JSON documents on stdout, notes and progress on stderr, and stopping by Ctrl-C."""

import json
import os
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


def say(document: Any, line: str, as_json: bool) -> None:
    """Print a result as its JSON document, or as a line for people."""
    print_json(document) if as_json else print(line)


def print_json_line(document: Any) -> None:
    """Print a JSON document as one line of stdout and flush it, for readers of a stream."""
    print(json.dumps(document, allow_nan=False), flush=True)


def to_stderr(line: str) -> None:
    """Print a note for the user on stderr."""
    print(f"lifelore: {line}", file=sys.stderr)


@contextmanager
def progress_bar(action: str) -> "Iterator[Progress]":
    """A callback ``(done, total, label)`` that draws a bar on stderr, with the elapsed and the remaining time.

    It draws to a terminal alone.
    """
    if not sys.stderr.isatty():
        yield lambda done, total, label: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    words = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[label]}")
    times = TimeElapsedColumn(), TextColumn("elapsed,"), TimeRemainingColumn(), TextColumn("left")
    with Bar(*words, *times, console=Console(stderr=True), transient=True) as bar:
        line = bar.add_task(action, total=None, label="")
        yield lambda done, total, label: bar.update(line, completed=done, total=total or None, label=label)


@contextmanager
def stop_on_interrupt() -> Iterator[Event]:
    """An event that the first Ctrl-C sets; the second Ctrl-C interrupts at once."""
    stop = Event()

    def interrupted(number, frame) -> None:
        if stop.is_set():
            raise KeyboardInterrupt
        stop.set()
        # Not by print, which fails where the signal interrupts a write to the same stream.
        os.write(2, b"stopping: finished work is stored (press Ctrl-C again to quit at once)\n")

    before = signal.signal(signal.SIGINT, interrupted)
    try:
        yield stop
    finally:
        signal.signal(signal.SIGINT, before)
