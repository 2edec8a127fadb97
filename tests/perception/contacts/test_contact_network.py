"""The edges of networks: those of networkx, ties included."""

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import pdist, squareform

from lifelore.perception.contacts.contact_network import spanning_edges
from lifelore.perception.contacts.contact_points import ContactPoint


def contact(at, other=3):
    return ContactPoint(np.array(at, float), np.array([0.0, 0, 1]), np.zeros(3), 1.0, 7, other)


def edges_of_networkx(positions):
    """The same tree by networkx over SciPy's distances, pairs in the order of their higher number."""
    distance = squareform(pdist(positions))
    graph = nx.Graph()
    graph.add_weighted_edges_from((i, j, distance[i, j]) for i in range(len(positions)) for j in range(i))
    return sorted(sorted(edge) for edge in nx.minimum_spanning_edges(graph, data=False))


@pytest.mark.slow
@settings(deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(2, 40))
def test_edges_among_scattered_points_are_those_of_networkx(seed, n):
    at = np.random.default_rng(seed).normal(0, 0.1, (n, 3))
    assert spanning_edges(at).tolist() == edges_of_networkx(at)


@pytest.mark.parametrize("shape", [(4, 4, 1), (3, 3, 3), (12, 1, 1)])
def test_edges_in_a_lattice_are_those_of_networkx(shape):
    at = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1).reshape(-1, 3) * 0.05
    for order in (slice(None), slice(None, None, -1), np.random.default_rng(0).permutation(len(at))):
        assert spanning_edges(at[order]).tolist() == edges_of_networkx(at[order])


def test_no_node_and_one_node_have_no_edges():
    assert spanning_edges(np.empty((0, 3))).shape == (0, 2)
    assert spanning_edges(np.zeros((1, 3))).shape == (0, 2)
