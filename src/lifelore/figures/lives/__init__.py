"""Pictures of lives in grid worlds, and of action priors: `life_curves`, `task_curves`, `world_map`, `prior_map`.

`floor_plan` and `prior_arrows` draw their parts; `prior_table` draws a prior over any features.
"""
