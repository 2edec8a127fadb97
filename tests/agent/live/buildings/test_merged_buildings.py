"""Memories of robots that each mapped one building: merged, they know one building."""

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.building_record import map_digest
from lifelore.agent.live.buildings.building_memory import buildings_in, forget_building
from lifelore.agent.live.buildings.merged_buildings import ROBOT, described, merge_memories
from lifelore.agent.live.buildings.recognition import recognised_place
from lifelore.agent.live.goals.destinations import NamedPlaces
from lifelore.agent.live.goals.goal_counts import GoalCounts
from lifelore.agent.live.transitions import BuildingGrid, frame_key, model_table, to_record
from lifelore.agent.travel import Travel
from lifelore.core.learning.known_world import UNKNOWN, unknown_world
from lifelore.core.protocols import Record
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, OccupancyMap, read_occupancy_map
from lifelore.domains.buildings.office import office_map
from lifelore.domains.buildings.registration import moved
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.worlds import WorldSettings, world_from_settings
from lifelore.memory import Memory, open_memory
from reproduction.own.o_04_same_building.edits import cropped, turned

MONDAY_8 = 1_704_096_000.0
OFFICE = office_map(1, 14.0, 12.0)


def quarter_turned(occupancy: OccupancyMap) -> OccupancyMap:
    """The same pixels as a robot maps them that stands turned to the left at another origin."""
    return replace(occupancy, state=np.ascontiguousarray(np.rot90(occupancy.state, -1)), origin=(2.0, -1.0, 0.0))


def seen_from(occupancy: OccupancyMap, point: tuple[float, float]) -> tuple[float, float]:
    """A point of the old map in the frame of `quarter_turned`."""
    x, y = np.subtract(point, occupancy.origin[:2])
    return float(y) + 2.0, occupancy.state.shape[1] * occupancy.resolution - float(x) - 1.0


def place_on(occupancy: OccupancyMap, memory: Memory):
    settings = WorldSettings("building", "somewhere/home.yaml")
    return recognised_place(settings, world_from_settings(settings, occupancy), occupancy, memory)


def meet(folder: Path, name: str, occupancy: OccupancyMap, places: dict[str, tuple[float, float]], seconds: float):
    """A memory of a robot that knows a building, some names, and slow moves and found goals around each name."""
    with open_memory(folder / f"{name}.db") as memory:
        place = place_on(occupancy, memory)
        names, travel, records = NamedPlaces.of(place), Travel(place.world, place.grid), list(place.news)
        goals = GoalCounts.recalled(place.world, place.grid, memory)
        for word, point in places.items():
            state = int(place.world.states_at(np.array([point]))[0])
            assert state >= 0
            records.append(names.record(word, point))
            for into in range(4):
                source = int(place.world.neighbour[state, into ^ 1])
                if source >= 0:
                    travel.observe(*np.tile([[source], [into]], 9), MONDAY_8 + 60 * np.arange(9), [seconds] * 9)
        found = goals.found(state)
        memory.contribute(name, [*records, *travel.news(), found], process="p", seq=0, task={})
    return folder / f"{name}.db"


DOCK, LAB = (4.25, 3.25), (10.75, 9.25)


def slow_cells(place, memory: Memory) -> dict[int, float]:
    """Seconds of the passes into each cell."""
    passes = Travel.recalled(place.world, place.grid, memory).passes
    into = place.world.neighbour.ravel()[passes.move]
    return dict(zip(into.tolist(), np.exp(passes.log_seconds / passes.passes).round(3).tolist(), strict=True))


@pytest.fixture
def merged(tmp_path) -> Path:
    """The memory of rosie after that of karl came in, who mapped the building a quarter turned."""
    rosie = meet(tmp_path, "rosie", OFFICE, {"dock": DOCK}, 1.0)
    karl = meet(tmp_path, "karl", quarter_turned(OFFICE), {"lab": seen_from(OFFICE, LAB)}, 9.0)
    with open_memory(rosie) as memory:
        counts, (entry,) = merge_memories(memory, [karl])
        assert counts == [{"added": 1, "already_there": 0, "forgotten": 0}]
        assert np.allclose(moved(tuple(entry["pose"]), np.array([seen_from(OFFICE, LAB)])), LAB, atol=0.02)
        assert described(entry) == "building home: joined to home, 100 % of the walls agree"
    return rosie


@pytest.mark.parametrize("turn", [False, True])
def test_what_both_learnt_is_known_on_either_map(merged, turn):
    occupancy, ends = (quarter_turned(OFFICE), [seen_from(OFFICE, p) for p in (DOCK, LAB)]) if turn else (
        OFFICE, [DOCK, LAB])  # fmt: skip
    with open_memory(merged) as memory:
        assert [(one["name"], one["maps"]) for one in buildings_in(memory)] == [("home", 2)]
        place = place_on(occupancy, memory)
        assert place.report["recognised"]
        points = NamedPlaces.of(place).points(memory)
        assert np.allclose([points["dock"], points["lab"]], ends, atol=0.02)
        dock, lab = place.world.states_at(np.array(ends)).tolist()
        assert slow_cells(place, memory) == {dock: 1.0, lab: 9.0}
        assert np.flatnonzero(GoalCounts.recalled(place.world, place.grid, memory).count).tolist() == sorted(
            [dock, lab]
        )
        driven = Travel.recalled(place.world, place.grid, memory).driven
        assert driven[[dock, lab]].all()
        assert driven.sum() == 2 + (place.world.neighbour[[dock, lab]] >= 0).sum()


def test_a_joined_map_that_changed_is_known_in_its_own_frame(merged):
    """Furniture that leaves too few walls for a comparison with all buildings."""
    changed = quarter_turned(OFFICE)
    state, free = changed.state.copy(), np.argwhere(changed.state == FREE)
    for row, column in free[np.random.default_rng(1).permutation(len(free))[:20]]:
        state[row : row + 6, column : column + 6] = OCCUPIED
    with open_memory(merged) as memory:
        world = world_from_settings(WorldSettings("building", "home.yaml"), changed)
        memory.contribute("karl", [moves_on(world, map_digest(changed))], process="t", seq=0, task={})
        place = place_on(replace(changed, state=state), memory)
        assert place.report["recognised"], place.report["reason"]
        assert np.allclose(NamedPlaces.of(place).points(memory)["dock"], seen_from(OFFICE, DOCK), atol=0.02)


def moves_on(world: GridWorld, building: str) -> Record:
    """All moves of a world, as a robot stored them in its own frame before its building was joined."""
    model = unknown_world(world.n_states, 4)
    model.target[:] = np.where(world.neighbour < 0, np.arange(world.n_states)[:, None], world.neighbour)
    model.percept[:] = world.percepts
    return to_record(world, model_table(world, model), UNKNOWN, BuildingGrid(frame_key(world), building=building))


def test_a_second_merge_changes_nothing_and_later_tasks_come_in(merged, tmp_path):
    turned = quarter_turned(OFFICE)
    with open_memory(merged) as memory:
        before = memory.revision()
        assert merge_memories(memory, [tmp_path / "karl.db"])[1] == []
        assert memory.revision() == before
        with open_memory(tmp_path / "karl.db") as karl:
            place = place_on(turned, karl)
            names = NamedPlaces.of(place)
            karl.contribute("karl", [names.record("gate", seen_from(OFFICE, DOCK))], process="q", seq=0, task={})
        assert merge_memories(memory, [tmp_path / "karl.db"])[1] == []
        assert np.allclose(NamedPlaces.of(place_on(OFFICE, memory)).points(memory)["gate"], DOCK, atol=0.02)


def test_memories_that_joined_each_other_agree_on_one_building(merged, tmp_path):
    with open_memory(meet(tmp_path, "rosie2", OFFICE, {"dock": DOCK}, 1.0)) as rosie:
        with open_memory(tmp_path / "karl.db") as karl:
            assert merge_memories(karl, [rosie.location])[1][0]["joined"] == "home"
        with open_memory(merged) as memory:
            merge_memories(memory, [tmp_path / "karl.db"])
            (one,) = buildings_in(memory)
            assert np.allclose(NamedPlaces.of(place_on(OFFICE, memory)).points(memory)["lab"], LAB, atol=0.02)
            forget_building(memory, one["name"])
            assert buildings_in(memory) == []


def test_to_forget_the_merge_takes_them_apart(merged, tmp_path):
    with open_memory(merged) as memory:
        memory.forget(ROBOT)
        assert len(buildings_in(memory)) == 2
        memory.forget("karl")
        other = meet(tmp_path, "other", office_map(2, 14.0, 12.0), {"dock": (7.75, 3.25)}, 2.0)
        (entry,) = merge_memories(memory, [other])[1]
        assert entry["joined"] is None
        assert "stays a building of its own: " in described(entry)


def test_a_name_at_two_points_is_a_question(tmp_path):
    rosie = meet(tmp_path, "rosie", OFFICE, {"dock": DOCK, "lab": LAB}, 1.0)
    other = seen_from(OFFICE, LAB), seen_from(OFFICE, LAB)
    karl = meet(tmp_path, "karl", quarter_turned(OFFICE), dict(zip(("dock", "lab"), other, strict=True)), 9.0)
    with open_memory(rosie) as memory:
        (entry,) = merge_memories(memory, [karl])[1]
        assert entry["names"] == ["dock"]
        assert "both know dock at different points" in described(entry)
        assert np.allclose(NamedPlaces.of(place_on(OFFICE, memory)).points(memory)["dock"], DOCK, atol=1e-6)


@pytest.mark.skipif("LIFELORE_DATA" not in os.environ, reason="LIFELORE_DATA is not set")
def test_the_real_map_turned_and_cropped(tmp_path):
    willow = read_occupancy_map(Path(os.environ["LIFELORE_DATA"]) / "maps" / "willow-full.yaml")
    part = cropped(turned(willow, 3.0), 0.25)
    with open_memory(tmp_path / "whole.db") as memory:
        memory.contribute("rosie", place_on(willow, memory).news, process="p", seq=0, task={})
        with open_memory(tmp_path / "part.db") as other:
            other.contribute("karl", place_on(part, other).news, process="p", seq=0, task={})
        (entry,) = merge_memories(memory, [tmp_path / "part.db"])[1]
        assert entry["joined"] == "home"
        assert entry["walls"] > 0.96
        assert abs(abs(entry["pose"][2]) - np.radians(3.0)) < np.radians(0.2)
        assert place_on(part, memory).report["name"] == "home"
        assert len(buildings_in(memory)) == 1


def test_an_own_building_that_the_other_memory_has_joined_is_reported(tmp_path, merged):
    with open_memory(tmp_path / "karl.db") as memory:
        _, report = merge_memories(memory, [merged])
        assert [one["joined"] for one in report] == [buildings_in(memory)[0]["name"], None]
        assert report[0]["walls"] > 0.95
        assert merge_memories(memory, [merged])[1] == []
