"""Peers: other methods that learn relations, with the interface of `RelationClassifier`, for comparison."""

from collections.abc import Callable

from lifelore.perception.peers.angle_distance_histogram import angle_distance_machine
from lifelore.perception.peers.bounding_box_rule import BoundingBoxRule
from lifelore.perception.peers.centroid_neighbours import centroid_neighbours
from lifelore.perception.peers.closest_point import closest_point
from lifelore.perception.peers.majority import Majority
from lifelore.perception.peers.orientation_histogram import orientation_trees
from lifelore.perception.peers.peer import Peer

PEERS: dict[str, Callable[[], Peer]] = {
    "majority": Majority,
    "bounding-box rule": BoundingBoxRule,
    "centroid k-NN": centroid_neighbours,
    "closest-point k-NN": closest_point,
    "orientation histogram": orientation_trees,
    "angle-distance histogram": angle_distance_machine,
}
"""Name → function that makes an unfitted peer. The thesis's own method is `RelationClassifier` with
``method="displacement"``."""
