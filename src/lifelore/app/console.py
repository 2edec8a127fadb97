"""Output of the command line: JSON documents on stdout, notes and progress on stderr, and stopping by Ctrl-C."""

import json
import os
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import timedelta
from threading import Event, Thread
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


class Pace:
    """Pieces of a job that are finished, and its elapsed and remaining time."""

    def __init__(self) -> None:
        self.done, self.total, self.label = 0, 0, ""
        self._began = time.monotonic()

    def update(self, done: int, total: int, label: str) -> None:
        """Note the number of finished pieces."""
        self.done, self.total, self.label = done, total, label

    def text(self) -> str:
        """For instance ``0:01:05 elapsed, about 0:03:10 left``, if open pieces take as long as finished ones."""
        elapsed = time.monotonic() - self._began
        left = f", about {_clock(elapsed / self.done * (self.total - self.done))} left" if self.done else ""
        return f"{_clock(elapsed)} elapsed{left}"


def _clock(seconds: float) -> str:
    return str(timedelta(seconds=round(seconds)))


@contextmanager
def progress_bar(action: str, every: float = 60.0) -> "Iterator[Progress]":
    """A callback ``(done, total, label)`` that shows progress on stderr with the elapsed and the remaining time.

    A terminal shows a bar. A pipe or file gets a line after each `every` seconds.
    """
    pace, ended = Pace(), Event()
    report = _draw_bar if sys.stderr.isatty() else _write_lines
    reporter = Thread(target=report, args=(action, pace, ended, every), daemon=True)
    reporter.start()
    try:
        yield pace.update
    finally:
        ended.set()
        reporter.join()


def _write_lines(action: str, pace: Pace, ended: Event, every: float) -> None:
    while not ended.wait(every):
        of = f" {pace.done}/{pace.total}" if pace.total else ""
        label = f" ({pace.label})" if pace.label else ""
        # In one piece, so that lines of several processes stay whole.
        sys.stderr.write(f"{action}{of}{label}: {pace.text()}\n")
        sys.stderr.flush()


def _draw_bar(action: str, pace: Pace, ended: Event, every: float) -> None:
    """Draw a bar ten times a second, so that its clock runs within a piece too."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    columns = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[state]}")
    with Progress(*columns, console=Console(stderr=True), transient=True, auto_refresh=False) as bar:
        line = bar.add_task(action, total=None, state="")
        over = False
        while not over:
            over = ended.wait(0.1)
            pieces = f"{pace.done}/{pace.total} " if pace.total else ""
            state = f"{pieces}{pace.label}  {pace.text()}"
            bar.update(line, completed=pace.done, total=pace.total or None, state=state, refresh=True)


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
