"""Buildings in memory: their maps, how a map that was saved again is recognised, and maps that change.

Read in this order: `building_record`, `recognition`, `building_memory`, `remembered_moves`, `map_watch`.
"""
