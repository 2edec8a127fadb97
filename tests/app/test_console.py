"""JSON documents, progress on a terminal and in a pipe, and Ctrl-C."""

import json
import os
import pty
import signal
import time

import pytest

from lifelore.app.console import _Pace, print_json, progress_bar, stop_on_interrupt


@pytest.mark.parametrize("number", [float("nan"), float("inf")])
def test_what_json_has_no_word_for_is_refused_before_anything_is_said(number, capsys):
    with pytest.raises(ValueError, match="JSON"):
        print_json({"fine": 1, "not": [number]})
    assert capsys.readouterr().out == ""


def test_one_document(capsys):
    print_json({"γ": [1, None, 0.5]})
    assert json.loads(capsys.readouterr().out) == {"γ": [1, None, 0.5]}


def test_without_a_terminal_short_work_prints_nothing(capfd):
    with progress_bar("living") as progress:
        progress(1, 2, "task 0")
    assert capfd.readouterr() == ("", "")


def test_without_a_terminal_long_work_prints_lines_also_within_a_piece(capfd):
    with progress_bar("living", every=0.02) as progress:
        progress(1, 3, "task 7")
        shown = ""
        while shown.count("\n") < 2:
            shown += capfd.readouterr().err
    assert shown.startswith("living 1/3 (task 7): 0:00:00 elapsed, about 0:00:00 left\n")
    time.sleep(0.05)
    assert capfd.readouterr() == ("", "")


def test_remaining_time_is_that_of_the_open_pieces():
    now = 100.0
    pace = _Pace(clock=lambda: now)
    now = 103.0
    assert pace.text() == "0:00:03 elapsed"  # nothing is known before the first piece is finished
    pace.update(0, 4, "")
    assert pace.remaining() is None
    now = 110.0
    pace.update(1, 4, "a")  # 10 s a piece
    assert pace.remaining() == 30
    now = 114.0
    assert pace.remaining() == 26
    now = 135.0  # the second piece takes long: two more pieces of 10 s at least
    assert pace.remaining() == 20
    assert pace.text() == "0:00:35 elapsed, about 0:00:20 left"
    pace.update(4, 4, "d")
    assert pace.remaining() == 0


def test_a_change_of_pace_is_followed():
    now = 0.0
    pace = _Pace(clock=lambda: now)
    for done in range(1, 61):
        now += 10.0 if done <= 40 else 1.0
        pace.update(done, 100, "")
    assert pace.remaining() == 40


def test_pieces_that_differ_in_turns_of_many_are_averaged():
    now, left = 0.0, []
    pace = _Pace(clock=lambda: now)
    for done in range(1, 1001):
        now += 10.0 if done % 50 < 25 else 1.0  # 5.5 s a piece
        pace.update(done, 2000, "")
        left.append(pace.remaining())
    assert left[-1] == pytest.approx(5.5 * 1000, rel=0.01)
    assert max(left[500:]) < 9000  # twenty pieces alone would say 15000 and 1000 in turns
    assert min(left[500:]) > 5000


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
