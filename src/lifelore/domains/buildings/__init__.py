"""Buildings: ROS occupancy maps and generated office floors as grid worlds.

Read in this order: `building`, `occupancy_map`, `map_image`, `inflation`, `slivers`; `office` generates a floor
with `office_plan` and `office_furniture`.
"""
