"""Point clouds: file formats, units, checks, voxels and distances between clouds.

Read in this order: `point_cloud`, `cloud_file` (with `pcd_file`, `ply_file`, `npz_file`), `cloud_columns`,
`label_rule`, `cloud_scale`, `voxel`; then `cell_cloud` and `nearest_points` for distances.
"""
