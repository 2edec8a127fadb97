"""Output of the command line: progress bars on stderr, JSON documents on stdout, and stopping by Ctrl-C."""

import json
import signal
import sys
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import timedelta
from threading import Event, Thread
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lifelore.core.protocols import Progress

INTERRUPTED = 130
"""Exit status after Ctrl-C, as in shells."""
RECENT, RECENT_SHARE = 20, 0.1
"""The mean time of this many finished pieces, or of this share of all pieces if that is more, predicts the next.

Fewer follow a change of pace faster. More are steadier where short and long pieces alternate, as in runs of
many claims.
"""


def print_json(document: Any) -> None:
    """Print a JSON document on stdout; raise ValueError for NaN and infinity, which JSON does not have."""
    print(json.dumps(document, indent=2, allow_nan=False))


def print_json_line(document: Any) -> None:
    """Print a JSON document as one line of stdout and flush it, for readers of a stream."""
    print(json.dumps(document, allow_nan=False), flush=True)


class _Pace:
    """Elapsed and remaining time of a job, from the pieces that are finished."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self.done, self.total, self.label = 0, 0, ""
        self._finished = deque([(clock(), 0)])
        self._began = clock()

    def update(self, done: int, total: int, label: str) -> None:
        self.done, self.total, self.label = done, total, label
        self._finished.append((self._clock(), done))
        while len(self._finished) > max(RECENT, int(RECENT_SHARE * total)) + 1:
            self._finished.popleft()

    def remaining(self) -> float | None:
        """Seconds until the end if the next pieces take as long as the last; None before the first is finished."""
        (first, before), (last, done) = self._finished[0], self._finished[-1]
        if done <= before:
            return None
        mean = (last - first) / (done - before)
        open_pieces = self.total - done
        # A piece that takes longer than the mean is about to end; those behind it still take the mean.
        return mean * max(open_pieces - 1, 0) + (max(mean - (self._clock() - last), 0.0) if open_pieces else 0.0)

    def text(self) -> str:
        """For instance ``0:01:05 elapsed, about 0:03:10 left``."""
        elapsed, left = self._clock() - self._began, self.remaining()
        return f"{_clock_text(elapsed)} elapsed" + ("" if left is None else f", about {_clock_text(left)} left")


def _clock_text(seconds: float) -> str:
    return str(timedelta(seconds=round(seconds)))


@contextmanager
def progress_bar(action: str, every: float = 60.0) -> "Iterator[Progress]":
    """A callback ``(done, total, label)`` that shows progress on stderr with the elapsed and the remaining time.

    A terminal shows a bar. A pipe or file gets a line after each `every` seconds.
    """
    pace = _Pace()
    with _bar(action, pace) if sys.stderr.isatty() else _lines(action, pace, every) as show:
        yield show


@contextmanager
def _bar(action: str, pace: _Pace) -> "Iterator[Progress]":
    from rich.console import Console
    from rich.progress import BarColumn, Progress, ProgressColumn, TextColumn
    from rich.text import Text

    class Pace(ProgressColumn):
        """Pieces and times, drawn again ten times a second, so that the clock runs within a piece too."""

        def render(self, task) -> Text:
            pieces = f"{pace.done}/{pace.total} " if pace.total else ""
            return Text(f"{pieces}{pace.label}  {pace.text()}")

    columns = (TextColumn("{task.description}"), BarColumn(), Pace())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        line = bar.add_task(action, total=None)

        def show(done: int, total: int, label: str) -> None:
            pace.update(done, total, label)
            bar.update(line, completed=done, total=total)

        yield show


@contextmanager
def _lines(action: str, pace: _Pace, every: float) -> "Iterator[Progress]":
    """Print a line of progress after each `every` seconds, also while one piece takes longer."""
    ended = Event()

    def report() -> None:
        while not ended.wait(every):
            of = f" {pace.done}/{pace.total}" if pace.total else ""
            label = f" ({pace.label})" if pace.label else ""
            # In one piece, so that lines of several processes stay whole.
            sys.stderr.write(f"{action}{of}{label}: {pace.text()}\n")
            sys.stderr.flush()

    reporter = Thread(target=report, daemon=True)
    reporter.start()
    try:
        yield pace.update
    finally:
        ended.set()
        reporter.join()


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
