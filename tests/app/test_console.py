"""JSON that others can read, a bar for a terminal only, and Ctrl-C that first asks politely."""

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


def test_without_a_terminal_there_is_no_bar(capfd):
    with progress_bar("living") as progress:
        assert progress is None
    assert capfd.readouterr() == ("", "")


def test_the_first_interrupt_asks_and_the_second_insists(capsys):
    before = signal.getsignal(signal.SIGINT)
    with stop_on_interrupt() as stop:
        assert not stop.is_set()
        signal.raise_signal(signal.SIGINT)
        assert stop.is_set()
        assert "Ctrl-C again" in capsys.readouterr().err
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is before


def read_all(terminal: int) -> str:
    """What was shown on a terminal until its last writer left."""
    shown = b""
    while True:
        try:
            part = os.read(terminal, 65536)
        except OSError:  # Linux's way to say that nobody holds the other end any more
            part = b""
        if not part:
            return shown.decode()
        shown += part


@pytest.mark.slow
def test_on_a_terminal_a_bar_moves_on_stderr_and_stdout_is_still_pure(start, known, monkeypatch):
    monkeypatch.setenv("TERM", "xterm-256color")
    ours, theirs = pty.openpty()
    process = start("live", "--domain", "lattice", "--tasks", 40, "--memory", known, "--json", stderr=theirs)
    os.close(theirs)
    shown = read_all(ours)
    os.close(ours)
    out = process.stdout.read()
    assert process.wait() == 0
    assert len(json.loads(out)["tasks"]) == 40
    assert "living" in shown
    assert "40/40" in shown
    assert "task 41" in shown  # the number of the last task: two were lived before
    assert "\x1b[" in shown
    assert "\x1b" not in out
    assert "living" not in out


@pytest.mark.slow
def test_into_a_pipe_nothing_is_said_beside_the_answer(start, answer, known):
    said = answer(start("live", "--domain", "lattice", "--tasks", 2, "--memory", known, "--json"))
    assert (said.status, said.err) == (0, "")
    assert len(said.document["tasks"]) == 2
