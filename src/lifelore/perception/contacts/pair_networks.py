"""`contact_networks`: the contact point networks of two bare clouds (thesis §2.3.4, Algorithm 1, steps 2 to 8)."""

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.perception.clouds.voxel import voxelised
from lifelore.perception.contacts.contact_network import ContactPointNetwork
from lifelore.perception.contacts.contact_settings import ContactSettings
from lifelore.perception.contacts.interface import DEFAULT_CONTACT_SETTINGS, interface
from lifelore.perception.contacts.near_pairs import NearPair, ObjectCloud
from lifelore.perception.separation.separator import checked_points

FIRST, SECOND = 2, 3
"""Numbers of the two objects in their networks."""


def contact_networks(
    points_a: ArrayLike, points_b: ArrayLike, settings: ContactSettings = DEFAULT_CONTACT_SETTINGS
) -> tuple[ContactPointNetwork, ContactPointNetwork]:
    """The contact point networks of two objects, that of `points_a` first (thesis §2.3, Algorithm 1).

    A support vector machine separates the clouds. Clusters of its support vectors are the contact points of
    either object; a minimum spanning tree joins them.

    Parameters
    ----------
    points_a, points_b : (n, 3), (m, 3) array or nested list of float
        One cloud for each object, metres, in one frame; in the networks they are objects 2 and 3. No distance is
        too large: whoever calls decides what is near.
    settings : ContactSettings
        ``ContactSettings.of_thesis()`` gives the form that the thesis prints.

    Returns
    -------
    tuple of two ContactPointNetwork
        At least one node each; with ``ContactSettings.of_thesis()`` a network may be empty.

    Raises
    ------
    InputError
        A cloud is empty, not finite, or not of shape (n, 3).

    Examples
    --------
    >>> lower = [[x / 300, y / 300, 0.0] for x in range(10) for y in range(10)]
    >>> upper = [[x, y, 0.004] for x, y, _ in lower]
    >>> under, over = contact_networks(lower, upper)
    >>> len(over.nodes), over.nodes[0].position.round(3).tolist(), over.nodes[0].normal.round(1)[2]
    (1, [0.015, 0.015, 0.004], np.float64(1.0))
    """
    a, b = checked_points("points_a", points_a), checked_points("points_b", points_b)
    cloud = LabelledCloud(np.concatenate([a, b]), np.repeat([FIRST, SECOND], [len(a), len(b)]))
    if settings.voxel:
        cloud = voxelised(cloud, settings.voxel)
    pair = NearPair(ObjectCloud(FIRST, cloud.of(FIRST)), ObjectCloud(SECOND, cloud.of(SECOND)), gap=np.nan)
    found = interface(pair, settings)
    return (
        ContactPointNetwork.from_contacts(FIRST, found.contacts_a),
        ContactPointNetwork.from_contacts(SECOND, found.contacts_b),
    )
