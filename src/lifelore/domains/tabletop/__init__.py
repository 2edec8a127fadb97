"""The tabletop: simulated scenes of objects, with true relations and a depth camera.

Read in this order: `tabletop` (draw scenes), `settings`, `shapes`, `kits`, `arrangements`, `groups`, `layout`,
`physics` (MuJoCo), `truth`, `photograph`, `depth_camera`, `scene_folder`.
"""
