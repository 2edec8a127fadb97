"""What memory knows of a building is written for nav2: places by name, times and refusals."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.live.buildings.recognition import recognised_place
from lifelore.agent.live.goals.destinations import NamedPlaces
from lifelore.agent.live.lore import Lore
from lifelore.agent.live.output.known_building import MASK_FILES, NAV2_FILES, KnownBuilding, write_known_building
from lifelore.agent.travel import Travel
from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.buildings.occupancy_map import FREE, read_occupancy_map, write_occupancy_map
from lifelore.domains.worlds import WorldSettings, map_from_settings, world_from_settings
from lifelore.memory import open_memory

MONDAY = 1_704_067_200.0
PLACES = {"dock": (0.55, 0.55), "lab": (5.3, 3.4)}


@pytest.fixture
def settings(tmp_path: Path) -> WorldSettings:
    """A room of 6 x 4 m."""
    state = np.zeros((82, 122), np.uint8)
    state[1:-1, 1:-1] = 254
    write_occupancy_map(tmp_path / "map.yaml", state, 0.05)
    return WorldSettings("building", str(tmp_path / "map.yaml"))


@pytest.fixture
def memory(tmp_path: Path, settings: WorldSettings) -> Path:
    """Of a robot that knows all places; those at x > 5 m were four times as slow."""
    given = map_from_settings(settings)
    with open_memory(tmp_path / "m.db") as opened:
        place = recognised_place(settings, world_from_settings(settings, given), given, opened)
        world = place.world
        lore = Lore.recalled(world, 1.0, opened, place.grid)
        lore.model.percept[:] = world.percepts
        travel, (state, action) = Travel(world, place.grid), np.nonzero(world.neighbour >= 0)
        slow = world.positions(state.astype(np.int32))[:, 0] > 5
        for drive in range(20):
            travel.observe(state, action, np.full(len(state), MONDAY + 86_400 * drive), np.where(slow, 4.0, 1.0))
        names = [NamedPlaces.of(place).record(*one) for one in PLACES.items()]
        records = [*place.news, lore.model_news(), *travel.news(), *names]
        opened.contribute("robot", records, process="p", seq=0, task={})
    return tmp_path / "m.db"


def pixel(path: Path, x: float, y: float) -> int:
    pixels = np.frombuffer(path.read_bytes()[-82 * 122 :], np.uint8).reshape(82, 122)
    return int(pixels[81 - math.floor(y / 0.05), math.floor(x / 0.05)])


def test_slow_places_cost_and_limit_the_speed(settings, memory, tmp_path):
    assert write_known_building(tmp_path / "out", settings, memory) == list(NAV2_FILES)
    assert pixel(tmp_path / "out" / "costs.pgm", 2, 2) == 0
    assert 40 < pixel(tmp_path / "out" / "costs.pgm", 5.5, 2) < 80
    assert pixel(tmp_path / "out" / "speed.pgm", 2, 2) == 0
    assert 20 < pixel(tmp_path / "out" / "speed.pgm", 5.5, 2) < 40
    assert (read_occupancy_map(tmp_path / "out" / "keepout.yaml").state[3:-3, 3:-3] == FREE).all()


def test_the_graph_joins_the_places_that_memory_knows_by_name(settings, memory, tmp_path):
    write_known_building(tmp_path, settings, memory)
    features = json.loads((tmp_path / "route_graph.geojson").read_text())["features"]
    places = {
        one["properties"]["metadata"]["name"]: tuple(one["geometry"]["coordinates"])
        for one in features
        if "name" in one["properties"].get("metadata", {})
    }
    assert places == PLACES


def test_a_model_of_its_own_decides_which_places_are_known(settings, memory, tmp_path):
    given = map_from_settings(settings)
    with open_memory(memory) as opened:
        place = recognised_place(settings, world_from_settings(settings, given), given, opened)
        model = Lore.recalled(place.world, 1.0, opened, place.grid).model
        model.percept[:] = -1
        assert not KnownBuilding.recalled(place, given, opened, model).write(tmp_path / "none")
        (state,) = place.world.states_at([PLACES["dock"]])
        model.percept[state] = place.world.percepts[state]
        known = KnownBuilding.recalled(place, given, opened, model)
    (tmp_path / "one").mkdir()
    (tmp_path / "one" / "route_graph.geojson").write_text("of earlier ways")
    assert known.write(tmp_path / "one") == list(MASK_FILES)
    assert set(MASK_FILES) == {path.name for path in (tmp_path / "one").iterdir()}


def test_a_robot_of_another_radius_gets_masks_of_its_own_places(settings, memory, tmp_path):
    other = WorldSettings("building", settings.map, robot_radius=0.3)
    assert set(MASK_FILES) <= set(write_known_building(tmp_path, other, memory))


def test_another_cell_and_a_file_as_folder_are_refused(settings, memory, tmp_path):
    other = WorldSettings("building", settings.map, cell=1.0)
    with pytest.raises(NotFoundError, match=r"memory knows no place of the map .*; live there first"):
        write_known_building(tmp_path, other, memory)
    with pytest.raises(InputError, match="out must name a folder"):
        write_known_building(memory, settings, memory)
