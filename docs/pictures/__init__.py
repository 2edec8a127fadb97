"""Pictures of the documentation that belong to no claim: worlds, buildings, scenes, a tabletop job, policy reuse.

Read in this order: `worlds`, `buildings`, `object_pairs`, `scene_layers`, `tabletop_job`, `policy_reuse`.
"""
