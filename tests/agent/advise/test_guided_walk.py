"""Walks of a person: errands, sight and experts of a building, and the advice of its desks step by step."""

from collections import deque
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.advise.guided_walk import begin_walk, resume_walk, take_step, walk_desk
from lifelore.agent.advise.walk_building import MOST_STATES, PLACE_NAMES, walk_building, walk_buildings
from lifelore.agent.live.buildings.recognition import recognised_place
from lifelore.agent.live.goals.destinations import NamedPlaces
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.streams import stream
from lifelore.domains.buildings.floor import floor_of
from lifelore.domains.grids.grid_world import MOVE_NAMES
from lifelore.domains.worlds import WorldSettings, map_from_settings, world_from_settings
from lifelore.memory import open_memory

MAZE = "advice:3"
OFFICE = Path(__file__).parents[3] / "examples" / "data" / "office.yaml"
DIRECTIONS = [(-1, 0), (1, 0), (0, 1), (0, -1)]
"""(row, column) of north, south, east and west."""


@pytest.fixture(scope="module")
def maze():
    return walk_building(MAZE, {})


@pytest.fixture
def memory(tmp_path):
    with open_memory(tmp_path / "walks.db") as memory:
        yield memory


@pytest.fixture
def desk(memory, maze):
    return walk_desk(memory, maze, True, {})


def moves_to(world, goal):
    """Moves from each state to a goal, breadth first; the slow twin."""
    moves, frontier = {goal: 0}, deque([goal])
    while frontier:
        state = frontier.popleft()
        for beside in world.neighbour[state]:
            if beside >= 0 and beside not in moves:
                moves[int(beside)] = moves[state] + 1
                frontier.append(int(beside))
    return moves


def test_served_maps_come_first():
    names = [found["name"] for found in walk_buildings({"hall": "hall.yaml", "attic": "attic.yaml"})]
    assert names[:2] == ["attic", "hall"]
    assert len(names) > 2
    for name in names[2:]:
        assert walk_building(name, {}).world.n_states <= MOST_STATES


@pytest.mark.parametrize("name", [MAZE, "building:0", "office"])
def test_the_shortest_way_of_an_errand_is_that_of_a_search(name):
    building = walk_building(name, {"office": str(OFFICE)})
    for number in range(4):
        start, place = building.errand(f"walk-{number}")
        found = moves_to(building.world, int(building.places[place]))
        assert building.distance[place, start] == found[start]


def test_places_are_apart_and_their_distances_are_those_of_a_search(maze):
    assert len(set(maze.places.tolist())) == len(PLACE_NAMES)
    for place, distance in zip(maze.places, maze.distance, strict=True):
        found = moves_to(maze.world, int(place))
        assert distance.tolist() == [found[state] for state in range(maze.world.n_states)]


def test_an_errand_begins_far_from_its_place_and_out_of_its_sight(maze):
    for number in range(50):
        start, place = maze.errand(f"walk-{number}")
        assert (start, place) == maze.errand(f"walk-{number}")
        assert start not in maze.in_sight(int(maze.places[place]))
        assert maze.distance[place, start] > np.median(maze.distance[place]) / 2
    assert len({maze.errand(f"walk-{number}")[1] for number in range(50)}) == len(PLACE_NAMES)


def test_experts_walk_a_shortest_way_to_each_place(maze):
    walks: dict[str, list[int]] = {}
    for step in maze.expert_steps:
        walks.setdefault(step["agent"], []).append(step["state"])
    assert len(walks) == 30 * len(PLACE_NAMES)
    for agent, states in walks.items():
        place = int(agent.split("/")[0])
        assert states[-1] == maze.places[place]
        assert len(states) - 1 == maze.distance[place, states[0]]


def test_a_served_map_has_the_names_of_its_jobs(memory):
    """Two named places of a job list; a third is blocked in the map. Without a job list, places have numbers."""
    assert walk_building("office", {"office": str(OFFICE)}, memory).names[:2] == ("place 1", "place 2")
    settings = WorldSettings(map=str(OFFICE))
    occupancy = map_from_settings(settings)
    world = world_from_settings(settings, occupancy)
    place = recognised_place(settings, world, occupancy, memory)
    floor = floor_of(occupancy, world)
    points = dict(zip(("dock", "goods lift"), floor.metres(floor.anchors[[7, 900]]).tolist(), strict=True))
    names = NamedPlaces.of(place)
    records = [names.record(name, (x, y)) for name, (x, y) in {**points, "wall": (900.0, 900.0)}.items()]
    memory.contribute("robot", [*place.news, *records], process="p", seq=0, task={})
    office = walk_building("office", {"office": str(OFFICE)}, memory)
    assert dict(zip(office.names, office.places.tolist(), strict=True)) == {"dock": 7, "goods lift": 900}
    walk = begin_walk(office, walk_desk(memory, office, True, {"office": str(OFFICE)}), "ada")
    assert walk["goal"] in points
    found = moves_to(office.world, int(office.places[office.names.index(walk["goal"])]))
    assert walk["shortest"] == found[walk["state"]]


def test_what_a_person_sees_is_near_and_not_behind_a_wall(maze, desk):
    view = begin_walk(maze, desk, "ada")
    row, column = view["at"]
    free = maze.world.state_of >= 0
    cells = {(r, c) for r, c, _ in view["seen"]}
    assert (row, column) in cells
    assert len(cells) < maze.world.n_states / 4
    for r, c, bits in view["seen"]:
        assert np.hypot(r - row, c - column) <= 6
        assert bits == sum(free[r + down, c + right] << move for move, (down, right) in enumerate(DIRECTIONS))
    # Along the row and the column, sight ends at the first wall.
    for down, right in DIRECTIONS:
        line = [(row + k * down, column + k * right) for k in range(1, 7)]
        walls = [k for k, cell in enumerate(line) if not free[cell]]
        open_part = line[: walls[0]] if walls else line
        assert {cell for cell in line if cell in cells} == set(open_part)


def test_a_step_moves_the_person_and_a_wall_does_not(maze, desk):
    view = begin_walk(maze, desk, "ada")
    assert (view["step"], view["reached"], view["goal"] in PLACE_NAMES) == (0, False, True)
    closed = next(move for move in MOVE_NAMES if move not in view["open"])
    bumped = take_step(maze, desk, "ada", 1, view["state"], closed)
    assert (bumped["step"], bumped["state"]) == (1, view["state"])
    moved = take_step(maze, desk, "ada", 2, bumped["state"], view["open"][0])
    assert moved["step"] == 2
    assert moved["state"] == maze.world.neighbour[view["state"], MOVE_NAMES.index(view["open"][0])]
    again = take_step(maze, desk, "ada", 2, bumped["state"], view["open"][0])
    assert again == moved


def test_the_shortest_way_ends_at_the_goal_in_sight(maze, desk):
    view = begin_walk(maze, desk, "ben")
    _, place = maze.errand("ben")
    at_first = view["p_normal"]
    for number in range(1, view["shortest"] + 1):
        assert not view["reached"]
        left = [
            maze.distance[place, target] if target >= 0 else np.inf
            for target in maze.world.neighbour[view["state"]]
        ]
        view = view | take_step(maze, desk, "ben", number, view["state"], MOVE_NAMES[int(np.argmin(left))])
    assert view["reached"]
    assert {"name": view["goal"], "at": view["at"]} in view["places"]
    # A shortest way is evidence for the experts' model.
    assert view["p_normal"] > at_first


def test_mistakes_are_named_and_change_nothing(maze, desk):
    state = begin_walk(maze, desk, "ada")["state"]
    with pytest.raises(InputError, match="step must be 1"):
        take_step(maze, desk, "ada", 3, state, "north")
    with pytest.raises(InputError, match="move must be one of"):
        take_step(maze, desk, "ada", 1, state, "up")
    with pytest.raises(InputError, match="state must be"):
        take_step(maze, desk, "ada", 1, maze.world.n_states, "north")
    with pytest.raises(InputError, match="number must be at least 1"):
        take_step(maze, desk, "ada", 0, state, "north")
    take_step(maze, desk, "ada", 1, state, "north")
    with pytest.raises(InputError, match="walk must be new"):
        begin_walk(maze, desk, "ada")
    for name in ("../map.yaml", "/etc/passwd", "attic", "building:77"):
        with pytest.raises(NotFoundError, match=r"building must be one of building:0, .*serve a map"):
            walk_building(name, {})


def test_a_building_too_large_to_walk_is_refused(monkeypatch):
    monkeypatch.setattr("lifelore.agent.advise.walk_building.MOST_STATES", 100)
    with pytest.raises(InputError, match="at most 100 places to walk, got 424"):
        walk_building(MAZE, {})


@pytest.mark.parametrize("name", [MAZE, "building:0"])
def test_every_errand_begins_where_a_lost_person_gets_advice(memory, name):
    # Experts have passed 73 % of the states of the office: of starts anywhere, one in three would have no advice.
    building = walk_building(name, {})
    desk = walk_desk(memory, building, True, {})
    for number in range(40):
        assert begin_walk(building, desk, f"walk-{number}")["theta"] is not None, number


def bump(building, desk, walk, times):
    """Answers to a person who tries closed moves only."""
    view = begin_walk(building, desk, walk)
    closed = next(move for move in MOVE_NAMES if move not in view["open"])
    return [take_step(building, desk, walk, number, view["state"], closed) for number in range(1, times + 1)]


def test_advice_comes_after_twenty_steps_of_who_seems_lost(memory, maze, desk):
    views = bump(maze, desk, "carl", 40)
    advised = [view["step"] for view in views if view["advise"]]
    # 0.75 steps are saved each step, first at the beginning: 15 are saved after 19 moves.
    assert advised[0] == 20
    assert advised == list(range(20, 41))
    assert all(view["gain"] >= 0.5 for view in views if view["advise"])
    silent = bump(maze, walk_desk(memory, maze, False, {}), "carl", 40)
    assert not any(view["advise"] for view in silent)
    assert [view["p_normal"] for view in silent[:20]] == [view["p_normal"] for view in views[:20]]
    # Without advice all steps are evidence; with it, the person's own ones.
    assert silent[-1]["p_normal"] < views[-1]["p_normal"]


def test_a_desk_that_is_opened_again_goes_on(memory, maze, desk):
    before = bump(maze, desk, "dora", 21)[-1]
    assert before["advise"]
    again = walk_desk(memory, maze, True, {})
    assert take_step(maze, again, "dora", 21, before["state"], "north")["step"] == 21
    assert again.id == desk.id


@pytest.mark.parametrize("advice", [True, False])
def test_a_walk_goes_on_as_it_was_left(memory, maze, advice):
    desk = walk_desk(memory, maze, advice, {})
    views = [begin_walk(maze, desk, "eva")]
    random = stream(0, "a walk that goes on")
    for number in range(1, 41):
        move = MOVE_NAMES[int(random.integers(4))]
        views.append(views[0] | take_step(maze, desk, "eva", number, views[-1]["state"], move))
    assert any(view["advise"] for view in views) is advice
    again = walk_desk(memory, maze, advice, {})  # as after a restart of the service
    for opened in (desk, again):
        resumed = resume_walk(maze, opened, "eva")
        way, known = resumed.pop("way"), resumed.pop("known")
        assert resumed == views[-1]
        assert way == [{name: view[name] for name in ("at", "p_normal", "gain", "advise")} for view in views]
        for name in ("seen", "places"):
            assert {str(one) for one in known[name]} == {str(one) for view in views for one in view[name]}
            assert len(known[name]) == len({str(one) for one in known[name]})
    after = [take_step(maze, opened, "eva", 41, views[-1]["state"], "north") for opened in (desk, again)]
    assert after[0] == after[1]
    assert after[0]["step"] == 41


def test_a_walk_that_nobody_has_begun_cannot_go_on(maze, desk):
    with pytest.raises(NotFoundError, match="no walk 'fay' has begun in advice:3; begin it first"):
        resume_walk(maze, desk, "fay")
    assert begin_walk(maze, desk, "fay")["step"] == 0


@pytest.mark.slow
def test_advice_helps_a_wanderer(maze, desk):
    """A wanderer walks straight on with probability 0.85, else turns at random, and follows advice."""

    def wander(walk, desk):
        random, heading = stream(0, "wanderer", walk), -1
        start, place = maze.errand(walk)
        state, number, theta = start, 0, None
        if desk is not None:
            begin_walk(maze, desk, walk)
        while state != maze.places[place] and number < 2000:
            ways = np.flatnonzero(maze.world.neighbour[state] >= 0)
            if theta is not None:
                heading = int(random.choice(4, p=theta))
            elif heading not in ways or random.random() > 0.85:
                heading = int(random.choice(ways))
            number += 1
            if desk is not None:
                view = take_step(maze, desk, walk, number, state, MOVE_NAMES[heading])
                theta = view["theta"] if view["advise"] else None
            after = int(maze.world.neighbour[state, heading])
            state = state if after < 0 else after
        return number / maze.distance[place, start]

    walks = [f"wanderer {number}" for number in range(8)]
    alone = np.median([wander(walk, None) for walk in walks])
    advised = np.median([wander(walk, desk) for walk in walks])
    assert advised < alone / 2
