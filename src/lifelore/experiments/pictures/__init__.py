"""Pictures of the documentation that belong to no claim: worlds, layers of a scene, a tabletop job, policy reuse.

Read in this order: `worlds`, `scene_layers`, `tabletop_job`, `policy_reuse`.
"""
