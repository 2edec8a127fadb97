"""Perception: point clouds in, relations between objects out (thesis ch. 2).

The sub-packages stand in the order of the data: `clouds` → `segmentation` → `separation` → `contacts` → `pairs` →
`trees` → `relations` → `reasoning` and `topology`. `scene` holds all layers of one scene, `perceived_scene` runs
all steps, `scene_json` and `scene_graph` write a scene, `peers` holds other methods for comparison.
"""
