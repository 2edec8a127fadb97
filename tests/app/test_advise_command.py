"""`lifelore advise`: one JSON line out for each line in."""

import io
import json

import numpy as np
import pytest

from lifelore.app.advise_command import advise
from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.worlds import make_world


@pytest.fixture
def experts(tmp_path):
    """One expert along the lattice's first row, to its east end."""
    world = make_world("lattice", seed=0)
    row = np.flatnonzero(world.cells[:, 0] == 1)
    path = tmp_path / "experts.jsonl"
    path.write_text(
        "".join(json.dumps({"agent": "e", "state": int(s), "action": "east"}) + "\n" for s in row[:-1])
    )
    return path


ASK = '{"agent": "lost", "state": [1, 5], "action": null}\n{"agent": "lost", "state": [1, 5], "action": "west"}\n'


def test_lines_from_stdin(experts, monkeypatch, capsys):
    monkeypatch.setattr("sys.stdin", io.StringIO(ASK + 4 * ASK.splitlines(keepends=True)[1]))
    advise("lattice", str(experts), method="thesis")
    first, second, *_, last = map(json.loads, capsys.readouterr().out.splitlines())
    assert first["agent"] == "lost"
    assert first["theta"] == pytest.approx([0.1 / 1.4, 0.1 / 1.4, 1.1 / 1.4, 0.1 / 1.4])
    assert first["p_normal"] == 0.5
    # One step west, against the expert: P(west | M₁) = .1/1.4 against 1/4.
    assert second["p_normal"] == pytest.approx((0.1 / 1.4) / (0.1 / 1.4 + 0.25))
    assert (second["advise"], last["advise"]) == (False, True)


def test_lines_from_a_file_as_one_document(experts, tmp_path, capsys):
    (tmp_path / "steps.jsonl").write_text(ASK)
    advise("lattice", str(experts), watch=str(tmp_path / "steps.jsonl"), as_json=True)
    document = json.loads(capsys.readouterr().out)
    assert list(document) == ["goals", "experts", "advice"]
    assert document["experts"] == 1
    assert len(document["advice"]) == 2


def test_a_bad_line_ends_it_after_the_good_ones(experts, monkeypatch, capsys):
    monkeypatch.setattr("sys.stdin", io.StringIO(ASK + "oops\n"))
    with pytest.raises(InputError, match="stdin line 3: not JSON, got 'oops'"):
        advise("lattice", str(experts))
    assert len(capsys.readouterr().out.splitlines()) == 2


def test_a_watch_file_that_is_not_there(experts):
    with pytest.raises(NotFoundError, match="file 'nowhere' does not exist"):
        advise("lattice", str(experts), watch="nowhere")
