"""The known part of a map by hand: cells from the top, percepts, arrows of both priors, and a large map."""

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.live.goals.destinations import Destination
from lifelore.agent.live.goals.job_list import Job
from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.agent.live.lore import PERCEPT_KEY
from lifelore.agent.live.transitions import model_table, to_record
from lifelore.agent.watch_life import known_map as module
from lifelore.agent.watch_life.known_map import known_map
from lifelore.core.learning.known_world import unknown_world
from lifelore.domains.buildings.occupancy_map import OccupancyMap, write_occupancy_map
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.worlds import WorldSettings, world_from_settings
from lifelore.memory import Memory, open_memory

#: Three cells in a row below one at the left:  a . .
#:                                              b c d
FREE = np.array([[True, False, False], [True, True, True]])


@pytest.fixture
def world() -> GridWorld:
    return GridWorld.from_free("corner", FREE)


@pytest.fixture
def memory(tmp_path, world):
    """A memory in which the cells a, b and c are known."""
    model = unknown_world(4, 4)
    model.percept[:3] = world.percepts[:3]
    model.target[0, 1] = 1  # from a to b
    table = model_table(world, model)
    record = to_record(world, table, np.full_like(table, -1))
    with open_memory(tmp_path / "m.db") as opened:
        opened.contribute("r", [record], process="p", seq=0, task={})
        yield opened


def known(memory: Memory, world: str, near: tuple[int, int] | None = None) -> dict:
    """The known map, which there must be."""
    found = known_map(memory, world, near)
    assert found is not None
    return found


def prior(memory: Memory, key: str, contexts) -> None:
    """Count north as the best move in some contexts, twice."""
    counts = ActionPrior(4, key=key)
    for _ in range(2):
        counts.update(contexts, [[True, False, False, False]] * len(contexts))
    memory.contribute("r", [counts.to_record({})], process=key, seq=0, task={})


def test_known_cells_stand_where_the_map_has_them(memory, world):
    found = known(memory, world.fingerprint)
    assert found["shape"] == [2, 3]
    assert (found["known"], found["untried"]) == (3, 2)
    assert {(row, column): untried for row, column, *_, untried in found["cells"]} == {
        (0, 0): 0, (1, 0): 2, (1, 1): 2
    }  # fmt: skip
    assert {(row, column): percept for row, column, percept, *_ in found["cells"]} == {
        (0, 0): int(world.percepts[0]), (1, 0): int(world.percepts[1]), (1, 1): int(world.percepts[2])
    }  # fmt: skip
    assert (found["prior"], found["arrows"], found["names"]) == (None, [], [])
    assert {arrow for *_, arrow, _ in found["cells"]} == {-1}


def test_arrows_are_those_of_the_observation_prior(memory, world):
    prior(memory, PERCEPT_KEY, [int(world.percepts[1])])
    found = known(memory, world.fingerprint)
    assert found["prior"] == "observation"
    arrows = {(row, column): arrow for row, column, _, arrow, _ in found["cells"]}
    # Two counts and α⁰ = 0.1: (2 + 0.1) / (2 + 4 · 0.1)
    assert found["arrows"][arrows[1, 0]] == pytest.approx([0.875, 0.042, 0.042, 0.042], abs=1e-3)
    assert arrows[0, 0] == arrows[1, 1] == -1


def test_of_a_large_map_the_nearest_places_are_given(memory, world, monkeypatch):
    monkeypatch.setattr(module, "MOST_CELLS", 2)
    found = known(memory, world.fingerprint, near=(1, 2))
    assert found["known"] == 3
    assert {tuple(cell[:2]) for cell in found["cells"]} == {(1, 1), (1, 0)}


@pytest.mark.parametrize("yaw", [0.0, np.pi / 2])
def test_named_places_stand_in_their_cells(tmp_path, yaw):
    """The life of a job list; the map's frame may be turned."""
    state = np.ones((42, 62), np.uint8)
    state[1:-1, 1:-1] = 0
    write_occupancy_map(tmp_path / "hall.yaml", OccupancyMap(state, 0.1, (3.0, -1.0, yaw)))
    settings = WorldSettings(map=str(tmp_path / "hall.yaml"))
    frame = world_from_settings(settings).frame
    ends = {"dock": (1.75, 2.75), "lift": (4.75, 1.25)}  # metres from the lower left corner, along the picture
    jobs = tuple(
        Job(Destination(tuple(frame.metres(x / frame.cell, y / frame.cell)[0].tolist()), name))
        for name, (x, y) in ends.items()
    )
    memory = MemorySettings(str(tmp_path / "m.db"))
    lived = live(LifeSettings(settings, goals=jobs, memory=memory, jobs=1))
    with open_memory(memory.location) as opened:
        found = known(opened, lived.world.fingerprint)
    rows = found["shape"][0]
    assert {one["name"]: one["at"] for one in found["names"]} == {
        name: [rows - 1 - int(y / frame.cell), int(x / frame.cell)] for name, (x, y) in ends.items()
    }


def test_of_a_world_without_moves_nothing_is_known(memory):
    assert known_map(memory, "elsewhere") is None
