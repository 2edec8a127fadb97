"""Peers: two other methods that name relations, with the interface of `RelationClassifier`."""

from collections.abc import Callable

from reproduction.own.o_07_unseen_scenes.peers.bounding_box_rule import BoundingBoxRule
from reproduction.own.o_07_unseen_scenes.peers.orientation_histogram import orientation_trees
from reproduction.own.o_07_unseen_scenes.peers.peer import Peer

PEERS: dict[str, Callable[[], Peer]] = {
    "bounding-box rule": BoundingBoxRule,
    "orientation histogram": orientation_trees,
}
"""Name → function that makes an unfitted peer. The thesis's own method is `RelationClassifier` with
``method="displacement"``."""
