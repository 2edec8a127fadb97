"""Buildings: ROS occupancy maps and generated office floors as grid worlds.

Read in this order: `building`, `occupancy_map`, `map_image`, `free_space`, `inflation`, `slivers`; then `floor`,
`line_of_sight`, `cost_ahead`, `clear_path` and `footprint` for paths in metres; `office` generates a floor with
`office_plan` and `office_furniture`; `building_days` blocks and crowds corridors by a hidden type of day,
`busy_building` by the clock; `busy_places` says where.
"""
