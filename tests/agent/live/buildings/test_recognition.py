"""Lives on maps that were saved again: the building is recognised, and nothing else is."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.building_record import Building, map_digest, remembered_buildings, remembered_map
from lifelore.agent.live.buildings.building_memory import buildings_in, forget_building
from lifelore.agent.live.buildings.recognition import fitting_building
from lifelore.agent.live.life import Life, live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Record
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, UNKNOWN, OccupancyMap, write_occupancy_map
from lifelore.domains.buildings.office import office_map
from lifelore.domains.buildings.registration import IDENTITY
from lifelore.domains.worlds import WorldSettings
from lifelore.memory import open_memory
from reproduction.own.o_04_same_building.edits import cropped, noisy, turned
from tests.domains.buildings.resaved_maps import padded, shifted

OFFICE = office_map(1, 14.0, 12.0)


def life_on(folder: Path, occupancy: OccupancyMap, name: str = "home", tasks: int = 1, **memory) -> Life:
    path = folder / f"{name}.yaml"
    write_occupancy_map(path, occupancy)
    where = MemorySettings(str(folder / "life.db"), **memory)
    return live(LifeSettings(WorldSettings(map=path), memory=where, tasks=tasks, compare=False))


def steps(life: Life) -> list[int]:
    return [task["agents"]["lore"]["steps_to_80"] for task in life.report["tasks"]]


@pytest.fixture(scope="module")
def lived(tmp_path_factory) -> bytes:
    """A memory after some tasks at home."""
    folder = tmp_path_factory.mktemp("home")
    first = life_on(folder, OFFICE, tasks=4)
    assert first.report["building"] == {
        "name": "home", "recognised": False, "agreement": None, "walls": None, "pose": None,
        "reason": "no building is remembered",
    }  # fmt: skip
    return (folder / "life.db").read_bytes()


@pytest.fixture
def home(lived, tmp_path) -> Path:
    (tmp_path / "life.db").write_bytes(lived)
    return tmp_path


def test_the_same_map_goes_on_as_before(home):
    again = life_on(home, OFFICE, tasks=2)
    building = again.report["building"]
    assert (building["name"], building["recognised"], building["pose"]) == ("home", True, [0, 0, 0])
    assert (building["agreement"], building["walls"]) == (1.0, 1.0)


def test_a_padded_or_shifted_map_is_as_good_as_the_same(home, lived):
    expected = steps(life_on(home, OFFICE, tasks=2))
    for edit in (padded, shifted):
        (home / "life.db").write_bytes(lived)
        again = life_on(home, edit(OFFICE), "again", tasks=2)
        assert again.report["building"]["recognised"]
        assert again.report["building"]["agreement"] == 1.0
        assert steps(again) == expected


def test_paths_are_in_the_new_maps_metres(home):
    before = life_on(home, OFFICE).world
    after = life_on(home, shifted(OFFICE, 3.0, -2.0), "again").world
    states = np.arange(before.n_states)
    assert after.positions(states) == pytest.approx(before.positions(states) + np.array([3.0, -2.0]), abs=0.01)


def test_a_turned_noisy_map_carries_its_transitions_over_and_is_known_the_next_time(home):
    new = noisy(turned(OFFICE, 3.0))
    first = life_on(home, new, "again").report["building"]
    assert first["recognised"]
    assert first["agreement"] > 0.6
    assert np.degrees(first["pose"][2]) == pytest.approx(-3, abs=0.1)
    again = life_on(home, new, "again").report["building"]
    assert again["pose"] == first["pose"]  # from memory, to the bit
    assert again["agreement"] > 0.9  # what the first life visited
    with open_memory(home / "life.db") as memory:
        assert buildings_in(memory) == [{"name": "home", "key": map_digest(OFFICE), "maps": 2, "grids": 2}]


def test_of_two_buildings_the_right_one_is_recognised(home):
    annex = life_on(home, office_map(2, 14.0, 12.0), "annex").report["building"]
    assert (annex["name"], annex["recognised"]) == ("annex", False)
    assert "the nearest is home" in annex["reason"] or "too few walls" in annex["reason"]
    again = life_on(home, turned(cropped(OFFICE, 0.8), 5.0), "again").report["building"]
    assert (again["name"], again["recognised"]) == ("home", True)
    other = life_on(home, padded(office_map(2, 14.0, 12.0)), "annex2").report["building"]
    assert (other["name"], other["recognised"]) == ("annex", True)


def test_another_floor_of_the_same_outline_in_the_same_frame_is_another_building(tmp_path):
    """Most places of two halls are open floor alike, and the outer walls agree: the goods stand elsewhere."""
    report = {}
    for floor in (1, 2):
        draw, state = np.random.default_rng(floor), np.full((400, 600), FREE, np.uint8)
        state[[0, 1, -2, -1]] = state[:, [0, 1, -2, -1]] = OCCUPIED
        for row, column in draw.integers(20, (360, 560), (14, 2)):
            state[row : row + 12, column : column + 16] = OCCUPIED
        report[floor] = life_on(tmp_path, OccupancyMap(state, 0.05), f"floor{floor}").report["building"]
    assert not report[2]["recognised"]
    assert "of the walls match" in report[2]["reason"]


def yard(column: int, corner: int = 0) -> OccupancyMap:
    """Free ground with a box, and around it ground that nobody has seen."""
    state = np.full((240, 360), UNKNOWN, np.uint8)
    state[20:220, 20:340] = FREE
    state[20:120, 260 - corner : 340] = UNKNOWN
    state[150:156, column : column + 12] = OCCUPIED
    return OccupancyMap(state, 0.05)


def test_a_yard_without_walls_is_known_by_its_border(tmp_path):
    """Its only box may move; a yard of another outline in the same frame is another one."""
    new, moved, other = (
        life_on(tmp_path, one, f"yard{number}").report["building"]
        for number, one in enumerate((yard(100), yard(180), yard(100, corner=140)))
    )
    assert [new["recognised"], moved["recognised"], other["recognised"]] == [False, True, False]
    assert moved["pose"] == [0, 0, 0]


def test_a_symmetric_building_is_refused_as_ambiguous(tmp_path):
    state = np.full((80, 120), OCCUPIED, np.uint8)
    state[2:-2, 2:-2] = FREE
    hall = OccupancyMap(state, 0.1)
    life_on(tmp_path, hall)
    again = life_on(tmp_path, shifted(hall), "again").report["building"]
    assert not again["recognised"]
    assert again["reason"] == "two poses fit home equally"
    # In the same frame, the frame tells the pose.
    assert life_on(tmp_path, padded(hall), "padded").report["building"]["name"] == "home"


def test_rows_of_shelves_are_recognised_by_the_walls_around_them(tmp_path):
    """One aisle further all shelves fit, and the outer walls do not; within the rows nothing tells the aisles."""
    state = np.full((200, 320), FREE, np.uint8)
    state[[0, 1, -2, -1]] = state[:, [0, 1, -2, -1]] = OCCUPIED
    for column in range(20, 290, 20):
        state[30:80, column : column + 8] = state[110:170, column : column + 8] = OCCUPIED
    shelves = OccupancyMap(state, 0.1)
    life_on(tmp_path, shelves)
    again = life_on(tmp_path, turned(shelves, 17.0), "again").report["building"]
    assert (again["name"], again["recognised"]) == ("home", True)
    part = replace(shelves, state=state[20:180, 60:260].copy())
    refused = life_on(tmp_path, turned(part, 17.0), "part").report["building"]
    assert refused["reason"] == "two poses fit home equally"


def test_a_pose_does_not_lead_by_leaving_changed_walls_out():
    """The ends of the rows were not seen: a few racks further, those that have gone lie beyond the other map."""

    def rows(gone: tuple[int, ...]) -> OccupancyMap:
        state = np.full((200, 500), UNKNOWN, np.uint8)
        state[10:190, 12:476] = FREE
        for rack in set(range(23)) - set(gone):
            state[30:170, 20 * rack + 20 : 20 * rack + 28] = OCCUPIED
        return OccupancyMap(state, 0.1)

    old = rows(())
    found, reason = fitting_building(turned(rows((20, 22)), 17.0), {Building.new(old, "home"): old})
    assert (found, reason) == (None, "two poses fit home equally")


def test_a_name_decides(home):
    with pytest.raises(InputError, match="remembered as 'home'"):
        life_on(home, OFFICE, building="west wing")
    with pytest.raises(InputError, match="does not fit building 'home'"):
        life_on(home, office_map(2, 14.0, 12.0), "annex", building="home")
    twin = life_on(home, padded(OFFICE), "twin", building="first floor").report["building"]
    assert (twin["name"], twin["recognised"]) == ("first floor", False)
    # Now two buildings fit the third map, and only a name can tell which it is.
    third = turned(OFFICE, 4.0)
    refused = life_on(home, third, "third").report["building"]
    assert "fit equally; name the building" in refused["reason"]
    named = life_on(home, turned(OFFICE, 5.0), "fourth", building="first floor").report["building"]
    assert (named["name"], named["recognised"]) == ("first floor", True)


def test_a_forgotten_building_is_a_new_one_and_the_prior_stays(home):
    with open_memory(home / "life.db") as memory:
        kinds = {entry["kind"] for entry in memory.show()["lore"]}
        assert kinds == {"action_prior", "building", "building_map", "transitions"}
        prior = next(iter(memory.keys("action_prior")))
        before = memory.recall("action_prior", prior[0], prior[1])
        with pytest.raises(NotFoundError, match="known buildings: home"):
            forget_building(memory, "annex")
        assert forget_building(memory, "home")["records"] == 3
        after = memory.recall("action_prior", prior[0], prior[1])
        assert isinstance(before, Record)
        assert isinstance(after, Record)
        assert np.array_equal(before.values, after.values)
        assert buildings_in(memory) == []
        assert memory.check() == []
    assert not life_on(home, OFFICE).report["building"]["recognised"]


def test_a_building_and_its_map_survive_memory(tmp_path):
    life_on(tmp_path, OFFICE)
    with open_memory(tmp_path / "life.db") as memory:
        (building,) = remembered_buildings(memory)
        record = memory.recall("building", building.key, 1)
        assert record is not None
        stored = remembered_map(building, record)
    assert building == Building.new(OFFICE, "home")
    # Stored rows begin at the lower left corner and run on to a whole number of runs.
    rows, columns = OFFICE.state.shape
    low, left = (round(stored.origin[axis] / stored.resolution) for axis in (1, 0))
    seen = np.full((rows + 40, columns + 40), UNKNOWN, np.uint8)
    seen[low : low + stored.state.shape[0], left : left + stored.state.shape[1]] = stored.state[::-1]
    assert np.array_equal(seen[:rows, :columns], OFFICE.state[::-1])
    # The same map again has no news.
    assert len(building.record(OFFICE, IDENTITY, record).slots) == 0
