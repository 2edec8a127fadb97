"""The verb `live`: a life of many tasks in one world, and what it leaves.

Read in this order: `life`, `life_settings`, `task_stream`, `model_task` and `q_task`, `lore`, `transitions`,
`baselines`, `task_result`, `summary`; then `report`, `exports`, `greedy_paths`, `l2_log`, `long_table` for the
output.
"""
