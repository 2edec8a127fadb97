"""Pictures of the documentation that belong to no claim: worlds, models, policy reuse.

Read in this order: `worlds`, `policy_reuse`.
"""
