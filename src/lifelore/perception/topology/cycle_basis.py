"""A minimum cycle basis of a weighted graph: independent loops that span all others, of least total length.

Three facts make it fast. Nodes of degree two only pass a cycle on, so chains of them are one edge. Each cycle is
the sum of cycles *root - shortest way - edge - shortest way - root*, none longer than itself, whichever of its
nodes is the root, and however ties between shortest ways are broken; so these, for a set of roots that meets every
cycle, are all that need be tried (Horton 1987). And a cycle whose two ways part only on the way is found from
where they part, shorter. Tried shortest first, each is kept if it is no sum of those before it (Gaussian
elimination over whole numbers as bit rows): greedy is exact, cycles being a matroid.

With r independent loops and k roots the work is k shortest-way trees and at most k r loops to try, a few
microseconds each: 0.03 s for 49 blocks in a square, 1 s for 400. The answer is exact whatever the size.

Why not networkx: `minimum_cycle_basis` finds the same loops in all of 12 networks of 26 real scenes, but takes 19
ms where this takes 4, and 515 ms against 4.6 on a grid of 7 × 7 nodes.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from functools import cache
from heapq import heappop, heappush
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError

Pairs = Sequence[tuple[int, int]]
_MOST_STEPS = 20_000
"""Roots times edges up to which shortest ways are found without SciPy, whose import takes 0.2 s."""
Way = tuple[int, ...]
"""Nodes along an edge of the contracted graph, both ends included."""


class Graph(NamedTuple):
    """A graph with several edges between two nodes.

    ends : (m, 2) int64, nodes 0 … n - 1, never the same twice
    lengths : (m,) float64
    ways : the original nodes of each edge, from its first end to its second
    n : number of nodes
    """

    ends: NDArray[np.int64]
    lengths: NDArray[np.float64]
    ways: list[Way]
    n: int


class Trees(NamedTuple):
    """Shortest ways from some roots: distances ``(k, n)``, and the node before each, negative where none."""

    roots: NDArray[np.int64]
    distance: NDArray[np.float64]
    before: NDArray[np.int64]


def minimum_cycle_basis(edges: Pairs, lengths: Sequence[float]) -> list[list[int]]:
    """The loops of a minimum cycle basis, each as its nodes in order, every edge of the graph given once.

    Parameters
    ----------
    edges : sequence of (int, int)
        Two different nodes each; no pair twice.
    lengths : sequence of float
        Their lengths, ≥ 0 and finite.

    Returns
    -------
    list of list of int
        As many as the graph has edges beyond a spanning forest. The same input gives the same loops; where several
        bases are shortest, which one is not said.

    Raises
    ------
    InputError
        A length is negative or not finite or missing, an edge joins a node to itself, or a pair stands twice.

    Examples
    --------
    A square with a diagonal: its two triangles.

    >>> minimum_cycle_basis([(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)], [1, 1, 1, 1, 1.4])
    [[0, 1, 2], [0, 3, 2]]
    """
    _check(edges, lengths)
    ways = _chains(edges)
    loops = [list(way[:-1]) for way in ways if way[0] == way[-1]]
    graph = _graph([way for way in ways if way[0] != way[-1]], edges, lengths)
    return loops + [_joined(graph, steps) for steps in _basis(graph)]


def _check(edges: Pairs, lengths: Sequence[float]) -> None:
    wrong = [length for length in lengths if not 0 <= length < np.inf]
    if wrong or len(lengths) != len(edges):
        raise InputError(f"lengths must be {len(edges)} finite numbers ≥ 0, got {wrong or len(lengths)}")
    if len({frozenset(edge) for edge in edges if edge[0] != edge[1]}) < len(edges):
        raise InputError("edges must join two different nodes each, and no pair twice")


def _chains(edges: Pairs) -> list[Way]:
    """The graph without its dead ends, cut at its branching nodes; a ring without any is one chain."""
    near: dict[int, set[int]] = {}
    for a, b in edges:
        near.setdefault(a, set()).add(b)
        near.setdefault(b, set()).add(a)
    _drop_dead_ends(near, list(near))
    left = {node: sorted(others) for node, others in sorted(near.items())}
    gone: set[tuple[int, int]] = set()
    chains = []
    for start in sorted(left, key=lambda node: (len(left[node]) == 2, node)):
        # Nodes of degree two come last: what chain they are on is known by then, but for rings.
        for second in left[start]:
            if (start, second) not in gone:
                chains.append(_walked(left, start, second))
                gone.update((b, a) for a, b in zip(chains[-1], chains[-1][1:], strict=False))
                gone.update(zip(chains[-1], chains[-1][1:], strict=False))
    return chains


def _drop_dead_ends(near: dict[int, set[int]], waiting: list[int]) -> None:
    """Take out nodes with less than two neighbours until none is left, beginning with those `waiting`."""
    while waiting:
        node = waiting.pop()
        if node in near and len(near[node]) < 2:
            for other in near.pop(node):
                near[other].discard(node)
                waiting.append(other)


def _walked(near: dict[int, list[int]], start: int, second: int) -> Way:
    way = [start, second]
    while way[-1] != start and len(near[way[-1]]) == 2:
        one, other = near[way[-1]]
        way.append(other if way[-2] == one else one)
    return tuple(way)


def _graph(ways: list[Way], edges: Pairs, lengths: Sequence[float]) -> Graph:
    length = {frozenset(edge): float(far) for edge, far in zip(edges, lengths, strict=True)}
    number = {node: k for k, node in enumerate(sorted({end for way in ways for end in (way[0], way[-1])}))}
    ends = np.array([(number[way[0]], number[way[-1]]) for way in ways], np.int64).reshape(-1, 2)
    far = [sum(length[frozenset(step)] for step in pairwise(way)) for way in ways]
    return Graph(ends, np.array(far), ways, len(number))


def _joined(graph: Graph, steps: list[tuple[int, bool]]) -> list[int]:
    """The nodes of a loop from its edges in order, each with whether it is walked from first end to second."""
    ways = (graph.ways[edge] if forward else graph.ways[edge][::-1] for edge, forward in steps)
    return [node for way in ways for node in way[:-1]]


def _basis(graph: Graph) -> Iterator[list[tuple[int, bool]]]:
    """The loops of the contracted graph, shortest first."""
    bits = _chords(graph)
    rank = sum(bit > 0 for bit in bits)
    if rank == 0:
        return
    lightest = _lightest(graph)
    trees = _trees(graph, lightest)
    ways = cache(lambda tree: _rows_to_root(trees.before[tree], lightest, bits))
    pivots: dict[int, int] = {}
    for tree, edge in _candidates(graph, trees, lightest):
        if _independent(pivots, _row(ways(tree), graph.ends[edge].tolist(), bits[edge])):
            yield _loop(graph, trees.before[tree], lightest, edge)
            if len(pivots) == rank:
                return


def _rows_to_root(before: NDArray[np.int64], lightest: dict[tuple[int, int], int], bits: list[int]) -> list:
    """For each node the next one towards the root, and the bit of the edge to it; the root's next is negative."""
    return [(x, bits[lightest[node, x]] if x >= 0 else 0) for node, x in enumerate(before.tolist())]


def _row(towards: list[tuple[int, int]], ends: list[int], row: int) -> int:
    """The bits of a loop: `row`, its edge's, and those of both ways to the root; what they share cancels."""
    for node in ends:
        further, bit = towards[node]
        while further >= 0:
            row ^= bit
            further, bit = towards[further]
    return row


def _independent(pivots: dict[int, int], row: int) -> bool:
    """Whether a loop is no sum of those in `pivots`, which are keyed by their highest bit; if so it joins them."""
    while row:
        known = pivots.get(row.bit_length())
        if known is None:
            pivots[row.bit_length()] = row
            return True
        row ^= known
    return False


def _chords(graph: Graph) -> list[int]:
    """One bit for each edge outside a spanning forest, 0 for its edges: these bits alone tell cycles apart."""
    part = list(range(graph.n))

    def root(node: int) -> int:
        while part[node] != node:
            part[node] = node = part[part[node]]
        return node

    bits, chords = [], 0
    for a, b in graph.ends.tolist():
        one, other = root(a), root(b)
        part[one] = other
        bits.append(1 << chords if one == other else 0)
        chords += one == other
    return bits


def _lightest(graph: Graph) -> dict[tuple[int, int], int]:
    """The shortest edge between two nodes, in both orders; the first of equals."""
    found: dict[tuple[int, int], int] = {}
    for edge, (a, b) in enumerate(graph.ends.tolist()):
        if (a, b) not in found or graph.lengths[edge] < graph.lengths[found[a, b]]:
            found[a, b] = found[b, a] = edge
    return found


def _trees(graph: Graph, lightest: dict[tuple[int, int], int]) -> Trees:
    """Shortest ways from the roots; in small graphs without SciPy unless two ways are equally short."""
    roots = _roots(graph)
    if len(roots) * len(lightest) > _MOST_STEPS:
        return _trees_of_scipy(graph, lightest, roots)
    near: list[list[tuple[int, float]]] = [[] for _ in range(graph.n)]
    for (a, b), edge in lightest.items():
        near[a].append((b, float(graph.lengths[edge])))
    trees = [tree for root in roots.tolist() if (tree := _shortest_ways(near, root)) is not None]
    if len(trees) < len(roots):
        return _trees_of_scipy(graph, lightest, roots)
    distances, before = zip(*trees, strict=True)
    return Trees(roots, np.array(distances), np.array(before, np.int64))


def _shortest_ways(near: list[list[tuple[int, float]]], root: int) -> tuple[list[float], list[int]] | None:
    """Distances from the root and the node before each, by Dijkstra; None if a node has two shortest ways."""
    distance, before = [np.inf] * len(near), [-1] * len(near)
    distance[root] = 0.0
    waiting = [(0.0, root)]
    while waiting:
        so_far, node = heappop(waiting)
        if so_far > distance[node]:
            continue
        for other, length in near[node]:
            way = so_far + length
            if way < distance[other]:
                distance[other], before[other] = way, node
                heappush(waiting, (way, other))
            elif way == distance[other]:
                return None
    return distance, before


def _trees_of_scipy(graph: Graph, lightest: dict[tuple[int, int], int], roots: NDArray[np.int64]) -> Trees:
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import dijkstra

    rows, columns = np.array(list(lightest)).T
    weights = graph.lengths[list(lightest.values())]
    matrix = csr_array((weights, (rows, columns)), shape=(graph.n, graph.n))
    distance, before = dijkstra(matrix, indices=roots, return_predecessors=True)
    return Trees(roots, distance, before.astype(np.int64))


def _roots(graph: Graph) -> NDArray[np.int64]:
    """Nodes that together meet every cycle: the one with most edges, again and again; ascending."""
    near: list[Counter[int]] = [Counter() for _ in range(graph.n)]
    for a, b in graph.ends.tolist():
        near[a][b] += 1
        near[b][a] += 1
    degree = np.bincount(graph.ends.ravel(), minlength=graph.n)
    roots = []
    while degree.max(initial=0) > 0:
        roots.append(int(degree.argmax()))
        waiting = [roots[-1]]
        while waiting:
            node = waiting.pop()
            degree[node] = 0
            for other, count in near[node].items():
                if degree[other] > 0:
                    degree[other] -= count
                    if degree[other] <= 1:
                        waiting.append(other)
            near[node].clear()
    return np.array(sorted(roots), np.int64)


def _candidates(graph: Graph, trees: Trees, lightest: dict[tuple[int, int], int]) -> Iterator[tuple[int, int]]:
    """(tree, edge) of each loop worth trying, shortest first."""
    a, b = graph.ends.T
    usual = np.zeros(len(a), bool)
    usual[list(lightest.values())] = True
    found, far = [], []
    for tree, (distance, before) in enumerate(zip(trees.distance, trees.before, strict=True)):
        branch = _branches(distance, before)
        closes = np.isfinite(distance[a]) & ~(usual & ((before[a] == b) | (before[b] == a)))
        # For each part of the graph one tree's loops all stay: they span it, whatever rounding hides elsewhere.
        if np.isfinite(distance[trees.roots[:tree]]).any():
            closes &= branch[a] != branch[b]
        edges = np.flatnonzero(closes)
        found.append(np.stack([np.full(len(edges), tree), edges], axis=1))
        far.append(distance[a[edges]] + graph.lengths[edges] + distance[b[edges]])
    order = np.argsort(np.concatenate(far), kind="stable")
    yield from map(tuple, np.concatenate(found)[order].tolist())


def _branches(distance: NDArray[np.float64], before: NDArray[np.int64]) -> NDArray[np.int64]:
    """For each node the first on the way to it that is not at its root's place; itself if it is there."""
    at_root = (before < 0) | (distance[np.maximum(before, 0)] == 0)
    branch = np.where(at_root, np.arange(len(before)), before)
    while not np.array_equal(further := branch[branch], branch):
        branch = further
    return branch


def _loop(
    graph: Graph, before: NDArray[np.int64], lightest: dict[tuple[int, int], int], edge: int
) -> list[tuple[int, bool]]:
    """The edges of a loop in order, with their directions: an edge, and the ways from its ends until they meet."""
    back, there = (_steps_to_root(before, end) for end in graph.ends[edge].tolist())
    while there and back and there[-1] == back[-1]:
        there.pop()
        back.pop()
    pairs = there + [(y, x) for x, y in reversed(back)]
    return [(edge, True), *((k := lightest[pair], int(graph.ends[k, 0]) == pair[0]) for pair in pairs)]


def _steps_to_root(before: NDArray[np.int64], node: int) -> list[tuple[int, int]]:
    steps = []
    while (further := int(before[node])) >= 0:
        steps.append((node, further))
        node = further
    return steps
