"""Which agents live together."""

import pytest

from lifelore.agent.live import baselines
from lifelore.agent.live.baselines import AGENTS, agents_for
from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.core.errors import NotFoundError
from lifelore.domains.worlds import WorldSettings


def test_agents_and_their_baselines():
    assert agents_for("lore") == ["lore", "scratch"]
    assert agents_for("prior") == ["prior", "scratch"]
    assert agents_for("scratch") == ["scratch"]
    assert agents_for("all") == list(AGENTS)


def test_refusals():
    with pytest.raises(NotFoundError, match="agent must be one of"):
        agents_for("nobody")


def test_the_four_are_a_factorial():
    assert {(AGENTS[n].uses_prior, AGENTS[n].remembers) for n in ("lore", "model", "prior", "scratch")} == {
        (True, True), (False, True), (True, False), (False, False),
    }  # fmt: skip
    assert len({AGENTS[n].exploration_strategy for n in ("lore", "model", "prior", "scratch")}) == 1


def test_an_agent_lives_alone_in_a_big_world_unless_the_settings_decide(tmp_path, monkeypatch):
    monkeypatch.setattr(baselines, "BIG", 100)
    lines = []
    settings = LifeSettings(WorldSettings("lattice"), memory=MemorySettings(str(tmp_path / "life.db")), tasks=1)
    report = live(settings, notify=lines.append).report
    assert len(lines) == 1
    said = "above 100 places scratch lives beside lore only with --set compare=true; a smaller size"
    assert said in lines[0]
    assert list(report["tasks"][0]["agents"]) == ["lore"]
    assert list(report["summary"]) == ["agents"]
    compared = LifeSettings(WorldSettings("lattice"), memory=settings.memory, tasks=1, compare=True)
    assert list(live(compared, notify=lines.append).report["tasks"][0]["agents"]) == ["lore", "scratch"]
    assert len(lines) == 1
