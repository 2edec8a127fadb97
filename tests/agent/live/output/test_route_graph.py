"""Route graphs are read by the rules of nav2's loader, and their routes cost what the cells cost."""

import json
from itertools import pairwise, permutations
from pathlib import Path

import networkx as nx
import numpy as np
import pytest

from lifelore.agent.live.output.route_graph import MOST_PLACES, write_route_graph
from lifelore.agent.travel.move_costs import MoveCosts
from lifelore.domains.buildings.building import building_from_map
from lifelore.domains.buildings.floor import floor_of
from lifelore.domains.buildings.occupancy_map import FREE, OccupancyMap

PLACES = {"dock": (0.55, 0.55), "lab": (5.3, 3.4), "shelf": (5.4, 0.6)}


@pytest.fixture
def two_rooms():
    """Two rooms of 3 x 4 m with a door between them, turned by 0.3; each move has costs of its own."""
    state = np.ones((82, 122), np.uint8)
    state[1:-1, 1:-1] = FREE
    state[:, 60:62] = 1
    state[30:52, 60:62] = FREE
    occupancy = OccupancyMap(state, 0.05, (0.0, 0.0, 0.3))
    world = building_from_map(occupancy, 0.5, 0.2)
    rng = np.random.default_rng(0)
    seconds, blocked = rng.uniform(1, 2, (world.n_states, 4)), rng.uniform(0, 0.2, (world.n_states, 4))
    return MoveCosts(world, seconds, blocked), floor_of(occupancy, world)


def turned(point: tuple[float, float]) -> tuple[float, float]:
    (x, y), cos, sin = point, np.cos(0.3), np.sin(0.3)
    return cos * x - sin * y, sin * x + cos * y


def loaded(path: Path) -> nx.DiGraph:
    """As nav2_route's GeoJsonGraphFileLoader reads a file, and with the checks of its planner.

    Points are nodes (id; frame, coordinates x and y), MultiLineStrings are edges (id, startid, endid; cost,
    overridable). Metadata are read as floats only where they are written with a decimal point.
    """
    graph, ids = nx.DiGraph(), []
    features = json.loads(path.read_text(encoding="utf-8"))["features"]
    for kind in ("Point", "MultiLineString"):
        for feature in features:
            about, geometry = feature["properties"], feature["geometry"]
            if geometry["type"] != kind:
                continue
            assert isinstance(about["id"], int)
            ids.append(about["id"])
            metadata = about.get("metadata", {})
            if kind == "Point":
                graph.add_node(about["id"], at=geometry["coordinates"], frame=about["frame"], **metadata)
                continue
            assert {about["startid"], about["endid"]} <= set(graph)
            assert about["cost"] > 0
            assert isinstance(about["overridable"], bool)
            assert all(isinstance(value, float) for value in metadata.values())
            assert not graph.has_edge(about["startid"], about["endid"])
            graph.add_edge(about["startid"], about["endid"], cost=about["cost"], **metadata)
    assert len(set(ids)) == len(ids) == len(features)
    assert graph.nodes
    assert graph.edges
    return graph


def cell_graph(costs: MoveCosts) -> nx.DiGraph:
    moves = np.argwhere(costs.world.neighbour >= 0)
    return nx.DiGraph(
        (int(s), int(costs.world.neighbour[s, a]), {"cost": costs.cost[s, a], "time": costs.seconds[s, a]})
        for s, a in moves
    )


def test_a_route_costs_what_its_cells_cost(two_rooms, tmp_path):
    costs, floor = two_rooms
    places = {name: turned(point) for name, point in PLACES.items()}
    known = np.ones(costs.world.n_states, bool)
    assert write_route_graph(tmp_path / "graph.geojson", costs, known, floor, places)
    graph, cells = loaded(tmp_path / "graph.geojson"), cell_graph(costs)
    node = {about["name"]: number for number, about in graph.nodes(data=True) if "name" in about}
    assert set(node) == set(PLACES)
    for a, b in permutations(PLACES, 2):
        ends = [floor.state_at(name, places[name]) for name in (a, b)]
        cost = nx.shortest_path_length(graph, node[a], node[b], "cost")
        assert cost == pytest.approx(nx.shortest_path_length(cells, *ends, "cost"), rel=1e-5)
        route = nx.shortest_path(graph, node[a], node[b], "cost")
        pieces = [graph.edges[piece] for piece in pairwise(route)]
        # With nav2's TimeScorer and PenaltyScorer the route costs the same.
        assert sum(piece["abs_time_taken"] + piece["penalty"] for piece in pieces) == pytest.approx(cost)
        assert all(0 < piece["blocked"] < 1 for piece in pieces)


def test_its_edges_are_straight_lines_clear_of_walls(two_rooms, tmp_path):
    costs, floor = two_rooms
    places = {name: turned(point) for name, point in PLACES.items()}
    write_route_graph(tmp_path / "graph.geojson", costs, np.ones(costs.world.n_states, bool), floor, places)
    graph, solid = loaded(tmp_path / "graph.geojson"), np.argwhere(floor.solid)
    assert {about["frame"] for _, about in graph.nodes(data=True)} == {"map"}
    assert len(graph) < costs.world.n_states / 2
    pixels = {number: floor.pixels(about["at"])[0] for number, about in graph.nodes(data=True)}
    for a, b in graph.edges:
        line = np.linspace(pixels[a], pixels[b], 200)
        assert np.hypot(*(line[:, None] - solid).T).min() > floor.radius


def test_places_without_a_known_way_are_left_out(two_rooms, tmp_path):
    costs, floor = two_rooms
    path = tmp_path / "graph.geojson"
    west = costs.world.cells[:, 1] < costs.world.shape[1] // 2
    places = {"dock": (0.55, 0.55), "door": (0.6, 3.3), "lab": (5.3, 3.4), "wall": (3.02, 0.5)}
    turned_places = {name: turned(point) for name, point in places.items()}
    assert write_route_graph(path, costs, west, floor, turned_places)
    names = {about["name"] for _, about in loaded(path).nodes(data=True) if "name" in about}
    assert names == {"dock", "door"}
    path.unlink()
    assert not write_route_graph(path, costs, west, floor, {"dock": turned_places["dock"]})
    assert not path.exists()


def test_two_names_of_one_place_share_its_node(two_rooms, tmp_path):
    costs, floor = two_rooms
    places = {"dock": turned((0.55, 0.55)), "charger": turned((0.6, 0.6)), "lab": turned((5.3, 3.4))}
    write_route_graph(tmp_path / "g.geojson", costs, np.ones(costs.world.n_states, bool), floor, places)
    names = {about.get("name") for _, about in loaded(tmp_path / "g.geojson").nodes(data=True)}
    assert names >= {"dock, charger", "lab"}
    assert MOST_PLACES >= 2


@pytest.mark.parametrize("origin", [(0.0, 0.0, 0.0), (-2.0, -1.0, 0.0), (0.35, 7.1, 0.0)])
def test_places_on_borders_of_cells_have_routes(origin, tmp_path):
    # Corners of four cells: in a part of the map they must lie in the same pixel as in the whole.
    state = np.ones((81, 121), np.uint8)
    state[1:-1, 1:-1] = FREE
    occupancy = OccupancyMap(state, 0.05, origin)
    world = building_from_map(occupancy, 0.5, 0.2)
    floor, n = floor_of(occupancy, world), world.n_states
    costs = MoveCosts(world, np.ones((n, 4)), np.zeros((n, 4)))
    places = {f"{x} {y}": (x / 2 + origin[0], y / 2 + origin[1]) for x in range(1, 12) for y in (2, 3, 5, 6)}
    assert write_route_graph(tmp_path / "graph.geojson", costs, np.ones(n, bool), floor, places)
    loaded(tmp_path / "graph.geojson")
