"""The verb `live`: a life of many tasks in one world, and what it leaves.

Read in this order: `life`, `life_settings`, `task_stream`, `shared_task`, `model_task` and `q_task`, `lore`,
`transitions`, `baselines`, `task_result`, `summary`. Sub-packages: `buildings` that memory recognises, `goals` of
the user, and the `output` of a life.
"""
