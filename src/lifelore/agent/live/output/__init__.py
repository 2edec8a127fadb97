"""What a life leaves: `report` with its pictures, `exports` and `nav2_masks` for robots, logs for statistics.

`greedy_paths` computes the paths that they show; the logs are `l2_log` and `long_table`.
"""
