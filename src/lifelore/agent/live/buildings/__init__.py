"""Buildings in memory: their maps, how a map that was saved again is recognised, and their moves.

Read in this order: `building_record`, `recognition`, `building_memory`, `remembered_moves`.
"""
