"""Scores of perception: relations, segmentations, networks and times.

Start with `relation_scoring`; `pair_validation` classifies pairs by the thesis's nearest neighbours.
"""
