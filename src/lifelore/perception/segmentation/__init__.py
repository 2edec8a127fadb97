"""Segmentation: the table plane, the frame of a scene, and objects of a cloud without labels.

Read in this order: `plane`, `table_frame`, `distance_segmentation`, `colour_segmentation`; then segmentation by
convexity: `surface_voxels`, `supervoxels`, `patch_convexity`, `patch_merging`, `convexity_segmentation`.
"""
