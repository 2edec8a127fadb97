"""The best known ways between the places of a building, as a graph for nav2's route server (GeoJSON).

1. The shortest routes between every two places, by the costs of moves between known cells.
2. Their union: nodes are the places and the cells where routes meet; the cells between two nodes are a chain.
3. The route server drives straight from node to node, so each chain becomes a clear path, and its corners nodes.
   A chain's seconds are split over the pieces by their length: a route costs what its cells cost.

The file has what the plugin ``GeoJsonGraphFileLoader`` of the package nav2_route reads.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from lifelore.agent.live.output.move_costs import MoveCosts
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
    """Write the graph of the ways between `places`, names and points in metres; False if there is no way to write.

    Places where the robot cannot stand, or to which no way is known, are left out.

    Raises
    ------
    OSError
        The file cannot be written.
    """
    features = route_graph(costs, known, floor, places)
    if features:
        document = {"type": "FeatureCollection", "name": "routes", "features": features}
        path.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    return bool(features)


def route_graph(
    costs: MoveCosts, known: NDArray[np.bool_], floor: Floor, places: Mapping[str, tuple[float, float]]
) -> list[dict[str, Any]]:
    """GeoJSON features: the nodes, then the directed edges; empty without two places that a way joins.

    Parameters
    ----------
    costs : MoveCosts
    known : (n_states,) bool
        Cells that ways may lead over.
    floor : Floor
    places : mapping of str to (x, y)
        At most `MOST_PLACES` of them are used, the first ones.
    """
    graph = _Graph(costs, floor)
    for name, point in list(places.items())[:MOST_PLACES]:
        graph.add_place(name, point)
    neighbour = costs.world.neighbour
    graph.possible = np.isfinite(costs.cost) & (neighbour >= 0) & known[:, None] & known[neighbour]
    tail, action = np.nonzero(graph.possible)
    edges = costs.cost[tail, action], (tail, neighbour[tail, action])
    used = _moves_of_routes(sparse.csr_array(edges, shape=(len(known),) * 2), sorted(graph.names))
    for chain in _chains(used, set(graph.names)):
        graph.add_chain(chain)
    return graph.features()


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
    """Nodes and edges as they are added."""

    costs: MoveCosts
    floor: Floor
    possible: NDArray[np.bool_] = field(init=False)  # (n_states, 4) moves that ways may lead over
    names: dict[int, list[str]] = field(default_factory=dict)
    _points: dict[int, NDArray[np.float64]] = field(default_factory=dict)
    _nodes: list[NDArray[np.float64]] = field(default_factory=list)
    _node_of: dict[int, int] = field(default_factory=dict)
    _corners: dict[Chain, list[int]] = field(default_factory=dict)
    _edges: list[tuple[int, int, dict[str, float]]] = field(default_factory=list)

    def add_place(self, name: str, point: tuple[float, float]) -> None:
        try:
            state = self.floor.state_at(name, point)
        except InputError:
            return
        self.names.setdefault(state, []).append(name)
        self._points.setdefault(state, np.array(point, float))

    def add_chain(self, chain: Chain) -> None:
        """Add the edges along a chain; both directions of a chain share their corners."""
        one_way = min(chain, chain[::-1])
        if one_way not in self._corners:
            self._corners[one_way] = self._new_corners(one_way)
        nodes = self._corners[one_way] if chain == one_way else self._corners[one_way][::-1]
        lengths = np.array([np.hypot(*(self._nodes[a] - self._nodes[b])) for a, b in pairwise(nodes)])
        about = self._about(chain)
        for (a, b), share in zip(pairwise(nodes), lengths / lengths.sum(), strict=True):
            scaled = {"abs_time_taken": about["seconds"] * share, "penalty": about["penalty"] * share}
            self._edges.append((a, b, scaled | {"blocked": about["blocked"]}))

    def _about(self, chain: Chain) -> dict[str, float]:
        """Expected seconds, seconds of penalty, and the probability that a move of the chain is refused."""
        tail, head = np.array(chain[:-1]), np.array(chain[1:])
        action = (self.costs.world.neighbour[tail] == head[:, None]).argmax(axis=1)
        seconds = float(self.costs.seconds[tail, action].sum())
        passed = float(np.prod(1 - self.costs.blocked[tail, action]))
        penalty = float(self.costs.cost[tail, action].sum()) - seconds
        return {"seconds": seconds, "penalty": penalty, "blocked": 1 - passed}

    def _new_corners(self, chain: Chain) -> list[int]:
        """The nodes of a clear path along a chain; its ends and its corners."""
        first, last = (self._node(state) for state in (chain[0], chain[-1]))
        (a, b), (c, d) = self._nodes[first].tolist(), self._nodes[last].tolist()
        beside = self._moves_beside(chain)
        path = clear_path(self._part(beside.ravel()), beside, (a, b), (c, d), beside)
        assert path is not None, "a route follows the moves of its floor"
        self._nodes.extend(path[1:-1])
        inner = range(len(self._nodes) - len(path) + 2, len(self._nodes))
        return [first, *inner, last]

    def _moves_beside(self, chain: Chain) -> NDArray[np.int64]:
        """Possible moves (n, 2) between the cells of a chain and those beside it that are not closed."""
        neighbour = self.costs.world.neighbour
        beside = neighbour[list(chain)][self.possible[list(chain)]]
        cells = np.union1d(chain, beside[~self._closed[beside]])
        tail, action = np.nonzero(self.possible[cells] & np.isin(neighbour[cells], cells))
        return np.column_stack([cells[tail], neighbour[cells[tail], action]]).astype(np.int64)

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
        return Floor(occupancy, floor.state[part], floor.solid[part], floor.robot_radius, floor.n_states)

    @cached_property
    def _closed(self) -> NDArray[np.bool_]:
        return self.costs.closed()

    def _node(self, state: int) -> int:
        if state not in self._node_of:
            if state not in self._points:
                self._points[state] = self.floor.metres(self.floor.anchors[[state]])[0]
            self._node_of[state] = len(self._nodes)
            self._nodes.append(self._points[state])
        return self._node_of[state]

    def features(self) -> list[dict[str, Any]]:
        """The nodes, numbered from 0, and the edges, numbered on."""
        names = {node: self.names[state] for state, node in self._node_of.items() if state in self.names}
        nodes = [_node_feature(i, point, names.get(i, ())) for i, point in enumerate(self._nodes)]
        edges = [
            _edge_feature(i, a, b, [self._nodes[a], self._nodes[b]], about)
            for i, (a, b, about) in enumerate(self._edges, start=len(nodes))
        ]
        return nodes + edges if edges else []


def _node_feature(number: int, point: NDArray[np.float64], names: Sequence[str]) -> dict[str, Any]:
    about = {"metadata": {"name": ", ".join(names)}} if names else {}
    geometry = {"type": "Point", "coordinates": _rounded(point)}
    return {"type": "Feature", "properties": {"id": number, "frame": FRAME} | about, "geometry": geometry}


def _edge_feature(
    number: int, start: int, end: int, points: Sequence[NDArray[np.float64]], about: Mapping[str, float]
) -> dict[str, Any]:
    # The loader takes a number without a decimal point for an integer, and its scorers read floats only.
    metadata = {name: float(round(value, 6)) for name, value in about.items()}
    cost = float(round(metadata["abs_time_taken"] + metadata["penalty"], 6))
    properties = {"id": number, "startid": start, "endid": end, "cost": cost, "overridable": True}
    geometry = {"type": "MultiLineString", "coordinates": [[_rounded(point) for point in points]]}
    return {"type": "Feature", "properties": properties | {"metadata": metadata}, "geometry": geometry}


def _rounded(point: NDArray[np.float64]) -> list[float]:
    return [float(round(value, 4)) for value in point.tolist()]
