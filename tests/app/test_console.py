"""JSON documents, progress on a terminal and in a pipe, and Ctrl-C."""

import contextlib
import io
import json
import os
import pty
import signal

import pytest

from lifelore.app.console import print_json, progress_bar, stop_on_interrupt


@pytest.mark.parametrize("number", [float("nan"), float("inf")])
def test_what_json_has_no_word_for_is_refused_before_anything_is_said(number, capsys):
    with pytest.raises(ValueError, match="JSON"):
        print_json({"fine": 1, "not": [number]})
    assert capsys.readouterr().out == ""


def test_one_document(capsys):
    print_json({"γ": [1, None, 0.5]})
    assert json.loads(capsys.readouterr().out) == {"γ": [1, None, 0.5]}


def test_without_a_terminal_nothing_is_drawn(capfd):
    with progress_bar("living") as progress:
        progress(1, 2, "task 0")
    assert capfd.readouterr() == ("", "")


class InterruptedStream(io.RawIOBase):
    """A stream to which each write is interrupted by Ctrl-C."""

    def writable(self) -> bool:
        return True

    def write(self, content) -> int:
        signal.raise_signal(signal.SIGINT)
        return len(content)


def test_an_interrupt_within_a_note_is_no_error(monkeypatch):
    stream = io.TextIOWrapper(io.BufferedWriter(InterruptedStream()), line_buffering=True)
    monkeypatch.setattr("sys.stderr", stream)
    with stop_on_interrupt() as stop:
        print("a note", file=stream, flush=True)
        assert stop.is_set()


def test_the_first_interrupt_asks_and_the_second_insists(capfd):
    before = signal.getsignal(signal.SIGINT)
    with stop_on_interrupt() as stop:
        assert not stop.is_set()
        signal.raise_signal(signal.SIGINT)
        assert stop.is_set()
        assert "Ctrl-C again" in capfd.readouterr().err
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.slow
def test_on_a_terminal_a_bar_moves_on_stderr_and_stdout_is_still_pure(start, known, monkeypatch):
    monkeypatch.setenv("TERM", "xterm-256color")
    ours, theirs = pty.openpty()
    process = start("live", "--domain", "lattice", "--tasks", 10, "--memory", known, "--json", stderr=theirs)
    os.close(theirs)
    shown = b""
    with contextlib.suppress(OSError):  # Linux's way to say that nobody holds the other end any more
        while part := os.read(ours, 65536):
            shown += part
    os.close(ours)
    out = process.stdout.read()
    assert process.wait() == 0
    assert len(json.loads(out)["tasks"]) == 10
    assert b"living" in shown
    assert b"10/10" in shown
    assert b"task 11" in shown  # the number of the last task: two were lived before
    assert b"\x1b[" in shown
    assert "\x1b" not in out
    assert "living" not in out
