"""Pictures of the documentation that belong to no claim: worlds, layers of a scene, policy reuse.

Read in this order: `worlds`, `scene_layers`, `policy_reuse`.
"""
