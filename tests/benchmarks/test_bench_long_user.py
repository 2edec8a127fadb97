"""The benchmark of a user with many decisions, small: what it times is what users get."""

import pytest

from benchmarks import BENCHES, bench
from benchmarks.interaction import long_user
from lifelore.agent.reuse.history import open_history, user_key
from lifelore.memory import open_memory


def test_the_history_written_at_once_is_one_of_decisions(tmp_path):
    study = long_user._study()
    with open_memory(tmp_path / "m.db") as memory:
        timed = long_user._goes_on(memory, study, 30)
        assert timed() > 0
        history = open_history(memory, study, user_key(study.name, "user of 30 decisions"))
        assert [one.number for one in history.decisions] == list(range(30 + 2 * long_user.EACH))
        assert all(one.outcome is not None and one.policy in study.active for one in history.decisions)
        assert memory.check() == []


def test_rows_and_goals(monkeypatch):
    monkeypatch.setattr(long_user, "DECISIONS", (5, 50))
    monkeypatch.setattr(long_user, "EACH", 2)
    assert "long_user" in BENCHES
    said = []
    document = bench("long_user", repeats=2, progress=lambda *at: said.append(at[:2]))
    assert said == [(done, 4) for done in (1, 2, 3, 4)]
    short, long, statements = document["rows"]
    assert long["ratio_to"] == short["name"]
    assert (short["value"] > 0, short["unit"]) == (True, "ms")
    assert [goal["goal"] for goal in document["goals"]] == ["<= 2.0", "<= 1.5", "<= 6"]
    assert document["goals"][0]["measured"] == pytest.approx(long["value"])
    assert (statements["value"], statements["unit"]) == (6, "statements")
