"""Buildings from maps: small floors worked by hand, and a twin that follows the definition pixel by pixel."""

from math import floor

import networkx as nx
import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.domains.buildings import building
from lifelore.domains.buildings.building import building_from_map
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, UNKNOWN, OccupancyMap

NORTH, SOUTH, EAST, WEST = range(4)
STATE_OF = {".": FREE, "#": OCCUPIED, "?": UNKNOWN}


def floor_plan(text: str, resolution: float = 0.1, origin=(0.0, 0.0, 0.0)) -> OccupancyMap:
    rows = [[STATE_OF[mark] for mark in line.strip()] for line in text.split()]
    return OccupancyMap(np.array(rows, np.uint8), resolution, origin)


def test_positions_turn_with_the_origin():
    plan = floor_plan("....\n....", 0.5, origin=(10.0, 20.0, np.pi / 2))
    world = building_from_map(plan, cell=0.5, robot_radius=0)
    # A quarter turn: x of the map points to the world's y. Lower left cell centre (0.25, 0.25) in the map.
    lower_left, upper_right = world.state_of[1, 0], world.state_of[0, 3]
    assert np.allclose(world.positions(np.array([lower_left])), [[10 - 0.25, 20 + 0.25]])
    assert np.allclose(world.positions(np.array([upper_right])), [[10 - 0.75, 20 + 1.75]])


def test_min_free_leaves_small_pieces_out():
    plan = floor_plan("""
        ....##
        ....#.
    """)
    assert building_from_map(plan, cell=0.2, robot_radius=0).n_states == 2
    plan = floor_plan("""
        .....#
        ....##
    """)
    assert building_from_map(plan, cell=0.2, robot_radius=0, min_free=0).n_states == 3
    assert building_from_map(plan, cell=0.2, robot_radius=0, min_free=0.25).n_states == 3
    assert building_from_map(plan, cell=0.2, robot_radius=0, min_free=0.26).n_states == 2


def test_what_makes_the_world_is_in_its_fingerprint():
    plan = floor_plan("..........\n" * 10)
    prints = {building_from_map(plan, cell, radius).fingerprint for cell in (0.2, 0.25) for radius in (0.1, 0.2)}
    assert len(prints) == 4
    assert building_from_map(plan, 0.2, 0.1).fingerprint in prints


def unknown_specks(state, resolution: float) -> set:
    """Unknown pixels whose island, corners included, covers at most 0.01 m²."""
    unknown = {tuple(at) for at in np.argwhere(state == UNKNOWN).tolist()}
    around = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    islands = regions(unknown, lambda at: {(at[0] + i, at[1] + j) for i, j in around} & unknown)
    return {at for island in islands if len(island) * resolution**2 <= 0.01 + 1e-9 for at in island}


def build_slowly(occupancy: OccupancyMap, cell: float, radius: float):
    """The definition, pixel by pixel: cells and neighbours."""
    state, resolution = occupancy.state, occupancy.resolution
    rows, columns = state.shape
    specks = unknown_specks(state, resolution)
    obstacles = np.array([at for at in np.argwhere(state != FREE).tolist() if tuple(at) not in specks])

    def is_free(r, c):
        if not (0 <= r < rows and 0 <= c < columns and state[r, c] == FREE):
            return False
        if min(r + 1, rows - r, c + 1, columns - c) * resolution <= radius + 1e-9:
            return False  # the centre of a pixel outside the picture is as near
        if not len(obstacles):
            return True
        distance = np.sqrt(((obstacles - (r, c)) ** 2).sum(axis=1)) * resolution
        return not (distance <= radius + 1e-9).any()

    free = {(r, c) for r in range(rows) for c in range(columns) if is_free(r, c)}
    last_row = floor((rows - 0.5) * resolution / cell + 1e-9)

    def cell_of(pixel):
        from_bottom = floor((rows - pixel[0] - 0.5) * resolution / cell + 1e-9)
        return last_row - from_bottom, floor((pixel[1] + 0.5) * resolution / cell + 1e-9)

    def beside(pixel):
        return [(pixel[0] + dr, pixel[1] + dc) for dr, dc in ((-1, 0), (1, 0), (0, 1), (0, -1))]

    pieces = {}
    for piece in regions(free, lambda p: [q for q in beside(p) if q in free and cell_of(q) == cell_of(p)]):
        key = cell_of(piece[0])
        if len(piece) > len(pieces.get(key, ())):
            pieces[key] = piece
    owner = {pixel: key for key, piece in pieces.items() for pixel in piece}
    joined = {
        key: {owner[q] for p in piece for q in beside(p) if q in owner} - {key} for key, piece in pieces.items()
    }
    largest = max(regions(pieces, lambda key: joined[key]), key=len, default=[])
    order = {key: number for number, key in enumerate(sorted(largest))}
    return sorted(largest), [
        [order[n] if n in joined[key] else -1 for n in beside(key)] for key in sorted(largest)
    ]


def regions(places, beside):
    """Connected regions in reading order of their first place."""
    graph = nx.Graph({place: list(beside(place)) for place in places})
    return sorted(sorted(region) for region in nx.connected_components(graph))


@pytest.mark.parametrize("seed", range(60))
def test_equals_the_twin(seed):
    rng = np.random.default_rng(seed)
    shape = rng.integers(4, 22, size=2)
    state = rng.choice([FREE, OCCUPIED, UNKNOWN], size=shape, p=[0.86, 0.09, 0.05]).astype(np.uint8)
    occupancy = OccupancyMap(state, float(rng.choice([0.05, 0.1, 0.3])))
    cell = occupancy.resolution * float(rng.choice([1.0, 2.0, 2.5, 3.0, 3.7]))
    radius = occupancy.resolution * float(rng.choice([0.0, 1.0, 1.5]))
    cells, neighbour = build_slowly(occupancy, cell, radius)
    if len(cells) < 2:
        with pytest.raises(InputError):
            building_from_map(occupancy, cell, radius, min_free=0)
        return
    world = building_from_map(occupancy, cell, radius, min_free=0)
    assert world.cells.tolist() == [list(place) for place in cells]
    assert world.neighbour.tolist() == neighbour


@pytest.mark.parametrize(
    ("key", "values", "words"),
    [
        ("cell", (float("nan"), -1.0, 0.0, 1e9), "cell must lie in"),
        ("cell", (0.09,), "cell must be at least a pixel"),
        ("cell", (900.0,), "only one cell"),
        ("robot_radius", (float("nan"), -0.1, 1e6), "robot_radius must lie in"),
        ("robot_radius", (99.0,), "no free cell is left for robot_radius"),
        ("min_free", (-0.1, float("nan")), "min_free must be a share"),
        ("discount", (1.0,), "discount must lie in"),
        ("goal_reward", (float("inf"),), "goal_reward must be a finite number"),
    ],
)
def test_each_broken_rule_is_one_clear_line(key, values, words):
    plan = floor_plan("....#\n.....\n.....")
    for value in values:
        with pytest.raises(InputError) as caught:
            building_from_map(plan, **({"cell": 0.2, "robot_radius": 0.0} | {key: value}))
        assert words in str(caught.value)
        assert "\n" not in str(caught.value)


def test_nothing_free_and_too_many_states(monkeypatch):
    with pytest.raises(InputError, match="no free cell"):
        building_from_map(floor_plan("??\n??"), 0.1, 0.0)
    monkeypatch.setattr(building, "MAX_STATES", 3)
    with pytest.raises(InputError, match="at most 3 cells are supported, got 4"):
        building_from_map(floor_plan("..\n.."), 0.1, 0.0)
