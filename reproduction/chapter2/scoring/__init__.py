"""Scores of perception: relations and segmentations.

Start with `relation_scoring`; `pair_validation` classifies pairs by the thesis's nearest neighbours.
"""
