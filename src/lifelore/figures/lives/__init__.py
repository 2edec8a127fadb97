"""Pictures of lives in grid worlds, `life_curves`, `world_map` and `drives`; and of action priors.

`floor_plan` and `map_plan` draw their ground; `prior_table` draws a prior over any features.
"""
