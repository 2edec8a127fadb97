"""The verb `live`: a life of many tasks in one world, and what it leaves.

Read in this order: `life`, `life_settings`, `task_stream`, `model_task` and `q_task`, `lore`, `transitions`,
`baselines`, `task_result`, `summary`; `own_places`, `job_list` and `destinations` for goals that the user chooses;
`remembered_moves` for questions to memory; then `report`, `exports`, `greedy_paths`, `l2_log` and
`long_table` for the output.
"""
