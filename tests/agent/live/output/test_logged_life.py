"""The data of a life's log: the last ways, goals and refusals, with their times."""

import numpy as np
import pytest

from lifelore.agent.live.life import live
from lifelore.agent.live.output.logged_life import logged_life
from lifelore.agent.live.output.nav2_masks import NO_OPINION
from lifelore.core.errors import InputError

from ..flat_settings import flat_settings

EAST = 2


@pytest.fixture(scope="module")
def life(tmp_path_factory):
    memory = str(tmp_path_factory.mktemp("life") / "m.db")
    return live(flat_settings(domain="building", tasks=2, agent="lore", jobs=1, memory=memory))


@pytest.mark.slow
def test_it_has_the_map_costs_ways_and_goals(life):
    occupancy, costs, ways, events = logged_life(life)
    assert occupancy is life.building.given
    assert costs.shape == occupancy.state.shape
    assert set(np.unique(costs)) == {0, NO_OPINION}
    assert [(name, seconds) for name, seconds, _ in ways] == [("goal 0", 0.0), ("goal 1", 1.0)]
    assert [(name, seconds) for name, seconds, _ in events] == [("reached goal 0", 0.0), ("reached goal 1", 1.0)]
    for (_, _, corners), (_, _, goal) in zip(ways, events, strict=True):
        assert corners[-1] == pytest.approx(goal)


@pytest.mark.slow
def test_with_a_clock_it_has_the_refusals_since_then(life):
    state = int(np.flatnonzero(life.world.neighbour[:, EAST] >= 0)[0])
    clock = [60.0, 1_704_103_205.0, 1_704_103_400.0]
    life.building.travel.observe([state] * 3, [EAST] * 3, clock, [np.nan, 2.0, np.nan])
    for task, minute in zip(life.report["tasks"], ("00", "03"), strict=True):
        task["clock"] = f"2024-01-01T10:{minute}:00"
        task["agents"]["lore"]["seconds"] = 30.0
    found = logged_life(life)
    assert [(name, seconds) for name, seconds, _ in found.events] == [
        ("reached goal 0", 1_704_103_230.0),
        ("reached goal 1", 1_704_103_410.0),
        ("refused east", 1_704_103_380.0),
    ]
    assert life.world.states_at([found.events[-1][2]]) == [state]


def test_a_life_without_a_building_has_no_log(tmp_path):
    lattice = live(flat_settings(domain="lattice", tasks=1, agent="lore", jobs=1, memory=str(tmp_path / "m.db")))
    with pytest.raises(InputError, match="log needs a life in a building, got domain lattice"):
        logged_life(lattice)
