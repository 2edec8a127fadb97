"""The tabletop: simulated scenes of objects, with true relations and a depth camera.

Read in this order: `tabletop` (draw scenes), `settings`, `shapes`, `kits`, `arrangements`, `groups`, `layout`,
`quota`, `physics` (MuJoCo), `truth`, `photograph`, `depth_camera`, `scene_folder`; for raw
frames of a whole room `furniture`, `raw_room`; for objects that are moved `pick_and_place`, `block_puzzle`.
"""
