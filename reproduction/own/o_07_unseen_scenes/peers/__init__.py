"""Peers: two other methods that name relations; they describe each near pair by a vector."""

from reproduction.own.o_07_unseen_scenes.peers.bounding_box_rule import BoundingBoxRule
from reproduction.own.o_07_unseen_scenes.peers.orientation_trees import OrientationTrees

PEERS = {"bounding-box rule": BoundingBoxRule, "orientation histogram": OrientationTrees}
"""Name → class. The thesis's own method is `RelationClassifier` with ``method="displacement"``."""
