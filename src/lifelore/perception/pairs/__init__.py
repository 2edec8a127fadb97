"""Pairs: features of an ordered pair of objects, and the classes of pairs.

Read in this order: `pair_features`, `scene_pairs`, `directed_label`, `gap_rule`, `objects_between`.
"""
