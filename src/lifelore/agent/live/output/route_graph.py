"""The best known ways between the places of a building, as a graph for nav2's route server (GeoJSON).

1. The shortest routes between every two places, by the costs of moves between known cells.
2. Their union: nodes are the places and the cells where routes meet; the cells between two nodes are a chain.
3. The route server drives straight from node to node, so each chain becomes a clear path, and its corners nodes.
   A chain's seconds are split over the pieces by their length: a route costs what its cells cost.

The file has what the plugin ``GeoJsonGraphFileLoader`` of the package nav2_route reads.
"""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from lifelore.agent.live.driven.route import moves_along
from lifelore.agent.travel.move_costs import MoveCosts
from lifelore.core.errors import InputError
from lifelore.domains.buildings.clear_path import clear_path
from lifelore.domains.buildings.floor import Floor
from lifelore.domains.buildings.occupancy_map import OccupancyMap

MOST_PLACES = 50
"""Largest number of places in a graph; more take more time: the routes grow with its square."""
FRAME = "map"
"""Frame of the nodes: that of the map, by nav2's usual name."""
_MARGIN = 3
"""Pixels around the part of a map in which a path is searched: those that tell a wall's surface."""

Chain = tuple[int, ...]
"""States from one node of the graph to the next."""


def write_route_graph(
    path: Path, costs: MoveCosts, known: NDArray[np.bool_], floor: Floor, places: Mapping[str, tuple[float, float]]
) -> bool:
    """Write the graph of the ways between places, nodes and directed edges; False if there is no way to write.

    Parameters
    ----------
    path : Path
    costs : MoveCosts
    known : (n_states,) bool
        Cells that ways may lead over.
    floor : Floor
    places : mapping of str to (x, y)
        Metres of the map's frame; at most `MOST_PLACES` of them are used, the first ones. Places where the robot
        cannot stand, or to which no way is known, are left out.

    Raises
    ------
    OSError
        The file cannot be written.
    """
    neighbour = costs.world.neighbour
    possible = np.isfinite(costs.cost) & (neighbour >= 0) & known[:, None] & known[neighbour]
    graph = _Graph(costs, floor, possible)
    for name, point in list(places.items())[:MOST_PLACES]:
        graph.add_place(name, point)
    tail, action = np.nonzero(possible)
    edges = costs.cost[tail, action], (tail, neighbour[tail, action])
    used = _moves_of_routes(sparse.csr_array(edges, shape=(len(known),) * 2), sorted(graph.places))
    for chain in _chains(used, set(graph.places)):
        graph.add_chain(chain)
    if graph.routes.edges:
        document = {"type": "FeatureCollection", "name": "routes", "features": _features(graph.routes)}
        path.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    return bool(graph.routes.edges)


def _moves_of_routes(graph: sparse.csr_array, ends: list[int]) -> dict[int, set[int]]:
    """The moves (state to next states) of the shortest routes between every two of `ends`."""
    used: dict[int, set[int]] = {}
    if not ends:
        return used
    _, before = csgraph.dijkstra(graph, indices=ends, return_predecessors=True)
    for source, previous in zip(ends, before, strict=True):
        passed = {source}
        for state in ends:
            while state not in passed and previous[state] >= 0:
                passed.add(state)
                used.setdefault(int(previous[state]), set()).add(state)
                state = int(previous[state])
    return used


def _chains(used: Mapping[int, set[int]], places: set[int]) -> Iterator[Chain]:
    """The used moves as chains between the places and the states where routes meet."""
    beside: dict[int, set[int]] = {}
    for tail, heads in used.items():
        for head in heads:
            beside.setdefault(tail, set()).add(head)
            beside.setdefault(head, set()).add(tail)
    nodes = {state for state, near in beside.items() if len(near) != 2 or state in places}
    for node in sorted(nodes):
        for head in sorted(used.get(node, ())):
            chain = [node, head]
            while chain[-1] not in nodes:
                # A route never turns round, so it leaves such a state by its other neighbour.
                (following,) = used[chain[-1]] - {chain[-2]}
                chain.append(following)
            yield tuple(chain)


@dataclass
class _Graph:
    """The graph as it is made: a node is a state, or a corner (chain, number), and has the point ``at``.

    possible : (n_states, 4) moves that ways may lead over
    places : by state, the point and the names of a place
    """

    costs: MoveCosts
    floor: Floor
    possible: NDArray[np.bool_]
    places: dict[int, tuple[NDArray[np.float64], list[str]]] = field(default_factory=dict)
    routes: nx.DiGraph = field(default_factory=nx.DiGraph)
    _nodes: dict[Chain, list] = field(default_factory=dict)

    def add_place(self, name: str, point: tuple[float, float]) -> None:
        try:
            state = self.floor.state_at(name, point)
        except InputError:
            return
        self.places.setdefault(state, (np.array(point, float), []))[1].append(name)

    def add_chain(self, chain: Chain) -> None:
        """Add the edges along a chain; both directions of a chain share their corners."""
        one_way = min(chain, chain[::-1])
        if one_way not in self._nodes:
            self._nodes[one_way] = self._new_nodes(one_way)
        nodes = self._nodes[one_way] if chain == one_way else self._nodes[one_way][::-1]
        points = np.array([self.routes.nodes[node]["at"] for node in nodes])
        lengths = np.hypot(*np.diff(points, axis=0).T)
        about = self._about(chain)
        for (a, b), share in zip(pairwise(nodes), lengths / lengths.sum(), strict=True):
            scaled = {"abs_time_taken": about["seconds"] * share, "penalty": about["penalty"] * share}
            self.routes.add_edge(a, b, **scaled, blocked=about["blocked"])

    def _about(self, chain: Chain) -> dict[str, float]:
        """Expected seconds, seconds of penalty, and the probability that a move of the chain is refused."""
        tail, action = np.array(chain[:-1]), moves_along(self.costs.world, np.array(chain))
        seconds = float(self.costs.seconds[tail, action].sum())
        passed = float(np.prod(1 - self.costs.blocked[tail, action]))
        penalty = float(self.costs.cost[tail, action].sum()) - seconds
        return {"seconds": seconds, "penalty": penalty, "blocked": 1 - passed}

    def _new_nodes(self, chain: Chain) -> list:
        """The nodes of a clear path along a chain: its ends and its corners."""
        for state in (chain[0], chain[-1]):
            point, names = self.places.get(state, (self.floor.metres(self.floor.anchors[[state]])[0], []))
            self.routes.add_node(state, at=point, names=names)
        (a, b), (c, d) = (self.routes.nodes[state]["at"].tolist() for state in (chain[0], chain[-1]))
        cells = self._cells_beside(chain)
        price = np.full(self.possible.shape, np.inf)
        inside = np.isin(self.costs.world.neighbour[cells], cells)
        price[cells] = np.where(self.possible[cells] & inside, 0.0, np.inf)
        path = clear_path(self._part(cells), (a, b), (c, d), price)
        assert path is not None, "a route follows the moves of its floor"
        corners = [(chain, number) for number in range(len(path) - 2)]
        for corner, point in zip(corners, path[1:-1], strict=True):
            self.routes.add_node(corner, at=point, names=[])
        return [chain[0], *corners, chain[-1]]

    def _cells_beside(self, chain: Chain) -> NDArray[np.int64]:
        """The cells of a chain, and those beside it that are not closed."""
        beside = self.costs.world.neighbour[list(chain)][self.possible[list(chain)]]
        return np.union1d(chain, beside[~self._closed[beside]]).astype(np.int64)

    def _part(self, states: NDArray[np.int64]) -> Floor:
        """The part of the floor around some cells, with what the robot could touch there, to search in."""
        floor, world = self.floor, self.costs.world
        centres = floor.pixels(world.positions(states.astype(np.int32)))
        reach = world.frame.cell / floor.occupancy.resolution + floor.radius + _MARGIN
        top, left = np.maximum(np.floor(centres.min(axis=0) - reach), 0).astype(int)
        low, right = np.ceil(centres.max(axis=0) + reach).astype(int)
        part = slice(top, low), slice(left, right)
        seen = floor.occupancy.state[part]
        x, y = floor.metres((top + len(seen) - 0.5, left - 0.5))[0].tolist()
        occupancy = OccupancyMap(seen, floor.occupancy.resolution, (x, y, floor.occupancy.origin[2]))
        return Floor(occupancy, floor.state[part], floor.solid[part], floor.robot_radius, floor.neighbour)

    @cached_property
    def _closed(self) -> NDArray[np.bool_]:
        return self.costs.closed()


def _features(routes: nx.DiGraph) -> list[dict[str, Any]]:
    """GeoJSON features: the nodes, numbered from 0, and the edges, numbered on."""
    number = {node: i for i, node in enumerate(routes)}
    nodes = []
    for node, about in routes.nodes(data=True):
        named = {"metadata": {"name": ", ".join(about["names"])}} if about["names"] else {}
        properties = {"id": number[node], "frame": FRAME} | named
        geometry = {"type": "Point", "coordinates": _rounded(about["at"])}
        nodes.append({"type": "Feature", "properties": properties, "geometry": geometry})
    edges = []
    for i, (a, b, about) in enumerate(routes.edges(data=True), len(nodes)):
        # The loader takes a number without a decimal point for an integer, and its scorers read floats only.
        metadata = {name: float(round(value, 6)) for name, value in about.items()}
        cost = float(round(metadata["abs_time_taken"] + metadata["penalty"], 6))
        properties = {"id": i, "startid": number[a], "endid": number[b], "cost": cost, "overridable": True}
        line = [[_rounded(routes.nodes[node]["at"]) for node in (a, b)]]
        geometry = {"type": "MultiLineString", "coordinates": line}
        edges.append({"type": "Feature", "properties": properties | {"metadata": metadata}, "geometry": geometry})
    return nodes + edges


def _rounded(point: NDArray[np.float64]) -> list[float]:
    return [float(round(value, 4)) for value in point.tolist()]
