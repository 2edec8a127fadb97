"""`lifelore teach` from a pipe: pictures, the report, and one JSON document."""

import io
import json

import pytest

from lifelore.action.demonstrations.demonstrations import read_demonstrations
from lifelore.app.teach_command import teach


@pytest.fixture
def type_in(monkeypatch):
    return lambda text: monkeypatch.setattr("sys.stdin", io.StringIO(text))


def test_pictures_and_a_line_for_people(tmp_path, capsys, type_in):
    type_in("w\nq\n")
    teach(str(tmp_path / "shown"), domain="lattice", size=7)
    out, err = capsys.readouterr()
    assert out.startswith("move with w a s d or the arrow keys")
    assert "task 1 of 3\n#######\n" in out
    assert out.count("@") == 2
    assert out.endswith(f"0 tasks shown in 0 steps, appended to {tmp_path / 'shown'}\n")
    assert err == ""


def test_odd_bytes_are_unknown_keys(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(b"\xff\xfe\nq\n"), encoding="utf-8"))
    teach(str(tmp_path / "shown"), domain="lattice", size=7)
    assert "is no move" in capsys.readouterr().out


def test_one_json_document(tmp_path, capsys, type_in):
    # Every corridor cell of the smallest lattice is reached by one of these walks round it.
    type_in("ddddssssaaaawwww" * 4 + "ssssddddwwwwaaaa" * 4 + "\n")
    teach(str(tmp_path / "shown"), name="ann", domain="lattice", size=7, tasks=1, seed=3, as_json=True)
    out, err = capsys.readouterr()
    report = json.loads(out)
    assert report["person"] == "ann"
    assert "task 1 of 1" in err
    told = read_demonstrations(tmp_path / "shown")
    assert report["shown"] == len(told) == 1
    assert report["steps"] == len(told[0].states)
