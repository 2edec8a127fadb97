"""The agents and the advice of lives in big worlds."""

from lifelore.agent.live import life_size
from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.agent.live.life_size import BIG, FIRST, LATER, estimated_seconds, size_of_life
from lifelore.domains.worlds import WorldSettings


def test_the_estimate_by_hand():
    assert estimated_seconds(1000, agents=2, tasks=3) == 2000 * (FIRST + 2 * LATER)


def test_above_the_limit_the_agent_lives_alone_unless_the_settings_decide():
    assert size_of_life(LifeSettings(), BIG // 10) == (["lore", "scratch"], None)
    names, notice = size_of_life(LifeSettings(tasks=1), BIG + 1)
    assert names == ["lore"]
    assert notice is not None
    assert "--set compare=true" in notice
    assert "--set cell=" in notice
    assert size_of_life(LifeSettings(tasks=1, agent="scratch"), BIG + 1)[0] == ["scratch"]
    assert size_of_life(LifeSettings(compare=True), BIG + 1)[0] == ["lore", "scratch"]
    assert size_of_life(LifeSettings(compare=False), 100) == (["lore"], None)
    assert len(size_of_life(LifeSettings(agent="all", compare=False), 100)[0]) == 7


def test_a_long_life_says_how_long():
    _, notice = size_of_life(LifeSettings(tasks=1000), 90_000)
    assert notice is not None
    assert "90,000 places" in notice
    assert "12 min for 1000 tasks of lore, scratch" in notice
    assert "fewer agents" in notice
    quiet = LifeSettings(tasks=1000, learner="q")
    assert size_of_life(quiet, 90_000)[1] is None


def test_a_life_in_a_big_world_has_no_comparison_and_notifies_first(tmp_path, monkeypatch):
    monkeypatch.setattr(life_size, "BIG", 100)
    lines = []
    where = MemorySettings(str(tmp_path / "life.db"))
    report = live(LifeSettings(WorldSettings("lattice"), memory=where, tasks=1), notify=lines.append).report
    assert len(lines) == 1
    assert "above 100 places scratch lives beside lore only with --set compare=true" in lines[0]
    assert list(report["tasks"][0]["agents"]) == ["lore"]
    assert list(report["summary"]) == ["agents"]
