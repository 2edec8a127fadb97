"""The benchmark of lives at a small size: its contract."""

from functools import partial

import pytest

from benchmarks import lives
from lifelore.agent.live.life_settings import LifeSettings
from tests.benchmarks.contract import checked


def test_the_answer_keeps_its_contract(monkeypatch):
    monkeypatch.setattr(lives, "TASKS", 2)
    monkeypatch.setattr(lives, "LifeSettings", partial(LifeSettings, episodes=20))
    told = []
    rows = checked(result := lives.bench_lives(1, lambda *at: told.append(at)), told)
    assert rows[lives.LORE]["ratio"] == pytest.approx(rows[lives.LORE]["value"] / rows[lives.SCRATCH]["value"])
    assert result["goals"][0]["measured"] == rows[f"{lives.EVERY}: wall time"]["value"] > 0
