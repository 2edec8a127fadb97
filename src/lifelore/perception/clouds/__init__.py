"""Point clouds: file formats, depth images, units, checks, voxels and distances between clouds.

Read in this order: `point_cloud`, `cloud_file` (with `pcd_file`, `ply_file`, `npz_file`), `depth_file` (with
`camera_intrinsics`, `depth_image`), `mask_file`, `cloud_columns`, `label_rule`, `cloud_scale`, `voxel`; then
`cell_cloud` and `nearest_points` for distances, `surface_normals`, `connected_parts`, `view_image` for lines of
sight, and `pixel_camera`.
"""
