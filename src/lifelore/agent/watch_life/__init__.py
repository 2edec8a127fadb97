"""What a memory tells of the lives in it, as JSON data for people who watch them.

Read in this order: `lives` (which lives there are, and their tasks), `known_map` (the known part of a map, and the
prior over its moves), `known_family` (types, what is expected of contexts, and curiosity).
"""
