"""The verb `live`: a life of many tasks in one world, and what it leaves.

Read in this order: `life`, `life_settings`, `grid_life`, `searched_life`, `task_search`, `task_result`, `lore`,
`transitions`, `baselines`, `summary`. Sub-packages: `buildings` that memory recognises, `goals` of the user,
`driven` jobs, and the `output` of a life.
"""
