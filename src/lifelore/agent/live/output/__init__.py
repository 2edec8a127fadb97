"""What a life leaves: `report` with its pictures, files for robots, and logs.

For nav2: `known_building`, which writes `nav2_masks` and `route_graph`. For other programs: `greedy_paths`. Logs:
`logged_life` for viewers, `l2_log` and `long_table` for statistics.
"""
