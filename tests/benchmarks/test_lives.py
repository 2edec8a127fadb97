"""The benchmark of lives at a small size: its contract, and that both ways of Q-learning make as many steps."""

from functools import partial

import pytest

from benchmarks import lives
from lifelore.agent.live.life_settings import LifeSettings
from lifelore.core.learning.q_learner import QLearning
from tests.benchmarks.contract import checked


def test_the_answer_keeps_its_contract(monkeypatch):
    monkeypatch.setattr(lives, "TASKS", 2)
    monkeypatch.setattr(lives, "Q_TASKS", 1)
    monkeypatch.setattr(lives, "LifeSettings", partial(LifeSettings, learning=QLearning(episodes=20)))
    told, asked = [], []
    monkeypatch.setattr(lives, "plain_seconds", lambda steps: asked.append(steps) or 2.0)
    rows = checked(result := lives.bench_lives(1, lambda *at: told.append(at)), told)
    assert rows[lives.PLAIN]["value"] == 2.0
    assert asked == [rows[f"steps of {lives.Q}"]["value"]]
    assert asked[0] > 1000
    assert rows[lives.LORE]["ratio"] == pytest.approx(rows[lives.LORE]["value"] / rows[lives.SCRATCH]["value"])
    assert result["goals"][0]["measured"] == rows[f"{lives.EVERY}: wall time"]["value"] > 0
