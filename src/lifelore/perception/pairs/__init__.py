"""Pairs: the numbers that describe an ordered pair of objects, and the classes a pair may have.

Read in this order: `pair_features`, `scene_pairs`, `directed_label`, `pair_class`, `gap_rule`, `objects_between`.
"""
