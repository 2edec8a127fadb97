"""The page /life: a memory as it grows, with its tasks, curves, map, beliefs over types, and curiosity."""
