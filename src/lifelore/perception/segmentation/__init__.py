"""Segmentation: the table plane, the frame of a scene, and objects of a cloud without labels.

Read in this order: `plane`, `range_noise`, `surface_patches`, `table_evidence`, `table_search`, `region`,
`camera_doubt`, `table_frame`, `table_labels`, `dropped_points`, `object_feet`, `scene_warnings`;
`object_segmentation`, `distance_segmentation`, `colour_segmentation`; then segmentation by convexity:
`surface_voxels`, `supervoxels`, `patch_convexity`, `patch_merging`, `hollow_objects`, `parted_objects`,
`cut_confidence`, `convexity_segmentation`.
"""
