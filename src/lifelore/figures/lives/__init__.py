"""Pictures of lives in grid worlds, `life_curves`, `world_map`, `drives` and `prior_map`.

`floor_plan` and `prior_arrows` draw their parts; `prior_table` draws a prior over any features.
"""
