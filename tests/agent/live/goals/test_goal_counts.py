"""Where goals were found: remembered, added up, forgotten with the building, and tried first."""

from dataclasses import replace

import numpy as np
import pytest

from lifelore.agent.live.buildings.building_memory import buildings_in, forget_building
from lifelore.agent.live.goals.goal_counts import KIND, VERSION, GoalCounts
from lifelore.agent.live.life import live
from lifelore.agent.live.transitions import BuildingGrid, frame_key, model_table, to_record
from lifelore.core.learning.known_world import UNKNOWN, unknown_world
from lifelore.domains.worlds import WorldSettings, make_world, world_from_settings
from lifelore.memory import open_memory

from ..flat_settings import flat_settings


def counts_of(world, corner=(0, 0)) -> GoalCounts:
    grid = BuildingGrid(frame_key(world), corner)
    return GoalCounts(world, grid, np.zeros(world.n_states, np.int64))


def test_the_belief_by_hand():
    counts = counts_of(make_world("lattice"))
    assert counts.belief()[2] == 0.5  # half a goal of none
    for goal in (7, 9, 7, 7, 3):
        counts.found(goal)
    places, chance, new = counts.belief()
    assert places.tolist() == [7, 3, 9]
    # Two of five goals were found once: (2 + 1/2) / (5 + 1).
    assert new == pytest.approx(2.5 / 6)
    assert chance.tolist() == pytest.approx([3.5 / 6 * 3 / 5, 3.5 / 6 / 5, 3.5 / 6 / 5])
    assert chance.sum() + new == pytest.approx(1)


def test_the_likely_place_near_by_comes_first_and_a_single_find_far_away_is_left_to_the_tour():
    counts = counts_of(make_world("lattice"))
    for goal in (7, 7, 7, 7, 3):
        counts.found(goal)
    steps = np.array([[0.0, 60.0], [60.0, 0.0], [10.0, 60.0]])
    assert counts.order(steps, np.array([7, 3]), 400.0).tolist() == [7, 3]
    assert counts.order(steps, np.array([7, 3]), 100.0).tolist() == [7]
    assert counts.order(steps[[1, 2]][:, [1]], np.array([3]), 400.0).tolist() in ([3], [])


def test_memory_adds_the_goals_of_all_robots(tmp_path):
    world = make_world("lattice")
    with open_memory(str(tmp_path / "memory.db")) as memory:
        for robot, goal in (("a", 7), ("b", 7), ("b", 9)):
            memory.contribute(robot, [counts_of(world).found(goal)], process=robot, seq=goal, task={})
        recalled = GoalCounts.recalled(world, BuildingGrid(frame_key(world)), memory)
    assert {int(s): int(recalled.count[s]) for s in np.flatnonzero(recalled.count)} == {7: 2, 9: 1}


def test_cells_of_another_size_are_other_places(tmp_path):
    office = {cell: world_from_settings(WorldSettings("building", cell=cell)) for cell in (0.5, 1.0)}
    grids = {cell: BuildingGrid(frame_key(world), building="b") for cell, world in office.items()}
    with open_memory(str(tmp_path / "memory.db")) as memory:
        news = GoalCounts.recalled(office[0.5], grids[0.5], memory).found(7)
        old = replace(GoalCounts.recalled(office[0.5], grids[0.5], memory).found(9), key="b")
        memory.contribute("a", [news, old], process="a", seq=0, task={})
        counts = {cell: GoalCounts.recalled(world, grids[cell], memory).count for cell, world in office.items()}
        assert np.flatnonzero(counts[0.5]).tolist() == [7, 9]
        # A record of an earlier version does not tell its cells; the moves of the building do.
        model = unknown_world(office[0.5].n_states, 4)
        model.percept[:] = office[0.5].percepts
        moves = to_record(office[0.5], model_table(office[0.5], model), UNKNOWN, grids[0.5])
        memory.contribute("a", [moves], process="a", seq=1, task={})
        assert GoalCounts.recalled(office[0.5], grids[0.5], memory).count.sum() == 2
        assert GoalCounts.recalled(office[1.0], grids[1.0], memory).count.sum() == 0
        # Also where the building was lived in with two sizes, if the goals were entered in cells of one of them.
        model = unknown_world(office[1.0].n_states, 4)
        model.percept[:3] = office[1.0].percepts[:3]
        others = to_record(office[1.0], model_table(office[1.0], model), UNKNOWN, grids[1.0])
        memory.contribute("a", [others], process="a", seq=2, task={})
        assert GoalCounts.recalled(office[0.5], grids[0.5], memory).count.sum() == 2
        assert GoalCounts.recalled(office[1.0], grids[1.0], memory).count.sum() == 0
    with open_memory(str(tmp_path / "older.db")) as memory:  # whose moves do not tell the size of cells either
        about = {name: value for name, value in moves.about.items() if name != "settings"}
        memory.contribute("a", [old, replace(moves, about=about)], process="a", seq=0, task={})
        assert GoalCounts.recalled(office[0.5], grids[0.5], memory).count.sum() == 1


def test_another_corner_of_the_grid_is_the_same_place():
    world = make_world("lattice")
    near, far = counts_of(world).found(7), counts_of(world, (5, 3)).found(7)
    assert far.slots - near.slots == (5 << 20) + 3


@pytest.mark.slow
def test_a_life_tries_destinations_first_and_forgets_them_with_the_building(tmp_path):
    path = str(tmp_path / "life.db")
    options = {"domain": "building", "destinations": 3, "tasks": 12, "memory": path, "compare": False}
    tasks = live(flat_settings(**options)).report["tasks"]
    last = [task["agents"] for task in tasks[-4:]]
    # Three remembered places lie at most some hundred steps apart; a tour of 1,890 places takes about 1,000.
    assert np.mean([agents["lore"]["steps_to_goal"] for agents in last]) < 400
    with open_memory(path) as memory:
        (key,) = [key for key, _, _ in memory.keys(KIND)]
        record = memory.recall(KIND, key, VERSION)
        assert record is not None
        assert record.values.sum() == 12
        forget_building(memory, buildings_in(memory)[0]["name"])
        assert not list(memory.keys(KIND))


def test_goals_anywhere_are_not_counted(tmp_path):
    path = str(tmp_path / "life.db")
    live(flat_settings(tasks=2, memory=path))
    with open_memory(path) as memory:
        assert not list(memory.keys(KIND))
