"""Minimum cycle bases by hand, and beside networkx on random graphs with ties, zeros and pieces."""

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.perception.topology import cycle_basis
from lifelore.perception.topology.cycle_basis import minimum_cycle_basis


def bit_rank(rows):
    """Rank over GF(2) of sets of edges, by plain elimination."""
    rows, rank = [set(row) for row in rows], 0
    while rows:
        row = rows.pop()
        if row:
            rank, pivot = rank + 1, min(row)
            rows = [other ^ row if pivot in other else other for other in rows]
    return rank


def steps(loop):
    return [(min(a, b), max(a, b)) for a, b in zip(loop, loop[1:] + loop[:1], strict=True)]


@st.composite
def weighted_graphs(draw, length):
    n = draw(st.integers(2, 12))
    pairs = [(a, b) for a in range(n) for b in range(a + 1, n)]
    edges = draw(st.lists(st.sampled_from(pairs), unique=True, max_size=30))
    return {edge: draw(length) for edge in edges}


def check(graph):
    loops = minimum_cycle_basis(list(graph), list(graph.values()))
    reference = nx.Graph()
    reference.add_weighted_edges_from((a, b, length) for (a, b), length in graph.items())
    assert len(loops) == len(graph) - len(reference) + nx.number_connected_components(reference)
    for loop in loops:
        assert len(set(loop)) == len(loop) >= 3
        assert set(steps(loop)) <= set(graph)
    assert bit_rank(steps(loop) for loop in loops) == len(loops)
    best = nx.minimum_cycle_basis(reference, weight="weight")
    totals = [sum(graph[edge] for loop in found for edge in steps(loop)) for found in (loops, best)]
    assert totals[0] == pytest.approx(totals[1], rel=1e-12)
    return loops, best


@pytest.mark.slow
@settings(deadline=None, max_examples=150)
@given(weighted_graphs(st.integers(1, 3).map(float)))
def test_as_short_as_networkx_where_many_ways_are_equally_long(graph):
    check(graph)


@pytest.mark.slow
@settings(deadline=None, max_examples=150)
@given(weighted_graphs(st.floats(1e-3, 1.0)))
def test_as_short_as_networkx_on_any_lengths(graph):
    check(graph)


@pytest.mark.slow
@settings(deadline=None, max_examples=100)
@given(weighted_graphs(st.sampled_from([0.0, 1.0, 2.0])))
def test_contacts_in_one_place_are_edges_without_length(graph):
    loops = minimum_cycle_basis(list(graph), list(graph.values()))
    # No oracle takes zeros: the same graph with a length too small to matter in their place has one.
    check({edge: length or 1e-6 for edge, length in graph.items()})
    near = minimum_cycle_basis(list(graph), [length or 1e-6 for length in graph.values()])
    totals = [sum(graph[edge] for loop in found for edge in steps(loop)) for found in (loops, near)]
    assert totals[0] == totals[1]


@pytest.mark.slow
def test_the_same_loops_as_networkx_where_only_one_basis_is_shortest():
    rng = np.random.default_rng(0)
    for seed in range(20):
        drawn = nx.gnp_random_graph(14, 0.3, seed=seed)
        loops, best = check({tuple(sorted(edge)): float(rng.uniform(0.1, 1)) for edge in drawn.edges})
        assert {frozenset(steps(loop)) for loop in loops} == {frozenset(steps(loop)) for loop in best}


@given(weighted_graphs(st.floats(1e-3, 1.0) | st.integers(1, 3).map(float)))
@settings(deadline=None, max_examples=60)
def test_the_same_loops_with_and_without_scipy(graph):
    def loops(most_steps):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(cycle_basis, "_MOST_STEPS", most_steps)
            return minimum_cycle_basis(list(graph), list(graph.values()))

    assert loops(10**6) == loops(-1)


def test_two_shortest_ways_are_left_to_scipy():
    square = [[(1, 1.0), (3, 1.0)], [(0, 1.0), (2, 1.0)], [(1, 1.0), (3, 1.0)], [(0, 1.0), (2, 1.0)]]
    assert cycle_basis._shortest_ways(square, 0) is None
    path = [[(1, 1.0)], [(0, 1.0), (2, 0.5)], [(1, 0.5)], []]
    assert cycle_basis._shortest_ways(path, 0) == ([0.0, 1.0, 1.5, np.inf], [-1, 0, 1, -1])


def test_chains_rings_and_dead_ends_by_hand():
    # A ring of four, 0 to 3, with a tail; a ring of three, 10 to 12, hanging on the tail's end; a ring apart.
    edges = [(0, 1), (1, 2), (2, 3), (0, 3), (3, 7), (7, 10), (10, 11), (11, 12), (10, 12), (7, 8)]
    edges += [(20, 21), (21, 22), (20, 22)]
    loops = minimum_cycle_basis(edges, [1.0] * len(edges))
    assert sorted(sorted(loop) for loop in loops) == [[0, 1, 2, 3], [10, 11, 12], [20, 21, 22]]
    assert loops == minimum_cycle_basis(edges, [1.0] * len(edges))
    assert minimum_cycle_basis([], []) == []
    assert minimum_cycle_basis([(0, 1), (1, 2)], [1.0, 1.0]) == []


def test_a_square_of_blocks_is_its_squares():
    # A lattice of 15 by 15 nodes: 196 squares of length 4, and nothing shorter.
    graph = nx.convert_node_labels_to_integers(nx.grid_2d_graph(15, 15))
    loops = minimum_cycle_basis(list(graph.edges), [1.0] * graph.number_of_edges())
    assert [len(loop) for loop in loops] == [4] * 196


@pytest.mark.parametrize(
    ("edges", "lengths", "said"),
    [
        ([(0, 1)], [-1.0], "lengths"),
        ([(0, 1)], [np.nan], "lengths"),
        ([(0, 1)], [np.inf], "lengths"),
        ([(0, 1)], [], "lengths"),
        ([(1, 1)], [1.0], "two different nodes"),
        ([(0, 1), (1, 0)], [1.0, 2.0], "no pair twice"),
    ],
)
def test_what_is_no_graph_is_refused(edges, lengths, said):
    with pytest.raises(InputError, match=said):
        minimum_cycle_basis(edges, lengths)
