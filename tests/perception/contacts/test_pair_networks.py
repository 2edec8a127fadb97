"""Networks of two bare clouds, in the default form and as the thesis prints them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.cluster.hierarchy import fcluster, linkage

import lifelore
from lifelore.core.errors import InputError
from lifelore.perception import ContactSettings, contact_networks
from lifelore.perception.separation.separator import separate

PRINTED = ContactSettings.of_thesis()


def plate(low, high, z, step=0.004) -> np.ndarray:
    x, y = (np.arange(a, b + step / 2, step) for a, b in zip(low, high, strict=True))
    return np.stack(np.meshgrid(x, y, [z], indexing="ij"), axis=-1).reshape(-1, 3)


SLAB = plate((0, 0), (0.2, 0.06), 0.0)
FEET = np.vstack([plate((0, 0), (0.03, 0.06), 0.004), plate((0.17, 0), (0.2, 0.06), 0.004)])


def test_two_feet_on_a_slab_are_two_contacts_of_either_object():
    slab, feet = contact_networks(SLAB, FEET)
    assert (slab.object_id, feet.object_id) == (2, 3)
    for network, height in ((slab, 0.0), (feet, 0.004)):
        assert network.edges.tolist() == [[0, 1]]
        at = network.positions[np.argsort(network.positions[:, 0])]
        np.testing.assert_allclose(at, [[0.015, 0.03, height], [0.185, 0.03, height]], atol=0.006)
    assert all(node.normal[2] > 0.9 and node.other == 2 for node in feet.nodes)


def test_lists_give_the_networks_of_arrays():
    arrays, lists = contact_networks(SLAB, FEET), lifelore.contact_networks(SLAB.tolist(), FEET.tolist())
    for one, other in zip(arrays, lists, strict=True):
        np.testing.assert_array_equal(one.positions, other.positions)


def test_as_printed_a_contact_is_the_plain_mean_of_a_cluster_on_one_object():
    found = separate(SLAB, FEET, length=PRINTED.length, cost=PRINTED.cost)
    networks = contact_networks(SLAB, FEET, PRINTED)
    for network, points in zip(networks, (found.points_first, found.points_second), strict=True):
        cluster = fcluster(linkage(points, "single"), PRINTED.linkage, "distance")
        rows = [points[cluster == number] for number in np.unique(cluster)]
        means = np.array([one.mean(axis=0) for one in rows if len(one) >= 7])
        assert len(means) >= 2
        np.testing.assert_allclose(sorted(network.positions.tolist()), sorted(means.tolist()), atol=1e-12)
        assert all(node.n_support >= 7 for node in network.nodes)


def test_as_printed_every_contact_of_fewer_than_seven_support_vectors_is_discarded():
    tip = np.array([[0.1, 0.03, 0.005]]) + np.arange(30)[:, None] * np.array([[0.0, 0.0, 0.004]])
    few = separate(SLAB, tip, length=PRINTED.length, cost=PRINTED.cost)
    assert len(few.alpha_second) < 7
    assert len(contact_networks(SLAB, tip, PRINTED)[1].nodes) == 0
    assert len(contact_networks(SLAB, tip, replace(PRINTED, as_printed=False))[1].nodes) == 1
    assert len(contact_networks(SLAB, tip, replace(PRINTED, min_support=1.0))[1].nodes) >= 1


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (np.empty((0, 3)), "points_b must be a cloud of shape"),
        ([[0.0, 1.0]], "points_b must be a cloud of shape"),
        ([[0.0, 1.0], [1.0]], "points_b must be a cloud of shape"),
        ([["left", "right", "up"]], "points_b must be a cloud of shape"),
        ([[0.0, 1.0, np.nan]], "points_b must be finite"),
    ],
)
def test_what_is_no_cloud_is_refused_by_name(wrong, message):
    with pytest.raises(InputError, match=message):
        contact_networks(SLAB, wrong)
