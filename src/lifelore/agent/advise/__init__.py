"""The verb `advise`: steps of agents with unknown goals in, advice out.

Read in this order: `advise`, `step_lines`, `expert_trajectories`.
"""
