"""``python -m benchmarks``: the list, one line for a mistake, JSON, a table, and the stored file."""

import json
from importlib import import_module
from types import SimpleNamespace

import pytest

import benchmarks
from benchmarks import BENCHES, rounds
from benchmarks.__main__ import main


@pytest.fixture
def quick(monkeypatch):
    """A benchmark of a line and a goal in the place of the real ones."""

    def run(repeats, progress):
        progress(1, 1, "round")
        rows = [rounds.row("ours", 2.0, "s"), rounds.row("theirs", None, "s", "ours")]
        return {"rows": rows, "goals": [rounds.at_most("ours", 3.0, 2.0)]}

    monkeypatch.setattr(benchmarks, "import_module", lambda name: SimpleNamespace(bench_kernels=run))


def test_all_ten_are_listed_with_a_line_each(capsys):
    assert main([]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(BENCHES)
    assert len(BENCHES) == 11
    assert all(callable(getattr(import_module(f"benchmarks.{name}"), f"bench_{name}")) for name in BENCHES)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["speed"], "benchmark must be one of kernels, "),
        (["speed", "--json"], "got 'speed'"),
        (["kernels", "--repeats", "0"], "repeats must lie in [1, 1000], got 0"),
        (["kernels", "--repeats", "x"], "--repeats: invalid int value: 'x'"),
    ],
)
def test_a_mistake_is_one_line_and_status_2(arguments, said, capsys):
    try:
        status = main(arguments)
    except SystemExit as left:
        status = left.code
    shown = capsys.readouterr()
    assert (status, shown.out, len(shown.err.splitlines())) == (2, "", 1)
    assert said in shown.err


def test_a_run_prints_and_stores_only_when_asked(quick, capsys, tmp_path, monkeypatch):
    monkeypatch.setattr("benchmarks.__main__.STORED", tmp_path / "stored")
    assert main(["kernels", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["bench"] == "kernels"
    assert list(tmp_path.iterdir()) == []
    assert main(["kernels", "--out", str(tmp_path / "own")]) == 0
    assert json.loads((tmp_path / "own" / "kernels.json").read_text()) == document
    shown = capsys.readouterr().out
    assert all(part in shown for part in ("ours", "theirs", "<= 3.0", "yes", "–"))
