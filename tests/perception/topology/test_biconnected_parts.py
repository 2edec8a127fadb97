"""Biconnected parts against networkx, on any graph."""

import networkx as nx
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.perception.topology.biconnected_parts import biconnected_parts

nodes = st.integers(0, 11)
pairs = st.tuples(nodes, nodes).filter(lambda pair: pair[0] < pair[1])


@pytest.mark.slow
@settings(max_examples=300, deadline=None)
@given(st.lists(pairs, max_size=30, unique=True))
def test_parts_are_those_of_networkx(edges):
    found = biconnected_parts(edges)
    expected = [part for part in nx.biconnected_component_edges(nx.Graph(edges)) if len(part) > 1]
    assert {frozenset(part) for part in found} == {frozenset(map(tuple, map(sorted, part))) for part in expected}
    assert len(found) == len(expected)
    assert all(part == [edge for edge in edges if edge in part] for part in found)


def test_a_long_ring_is_one_part():
    ring = [(k, (k + 1) % 5000) for k in range(5000)]
    assert biconnected_parts(ring) == [ring]
