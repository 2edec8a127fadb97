"""What was learnt, kept between runs and shared in a fleet; the only room that speaks SQL.

A memory is a set of *contributions* (what one robot learnt from one task) and a set of *tombstones* (what
was forgotten). Merging two memories unites both sets, so it is exact in any order and grouping. Everything
else, the cells and counts that `Memory.recall` reads, is a cache that `Memory.rebuild` can recompute.
"""

from lifelore.memory.memory import Memory, open_memory

__all__ = ["Memory", "open_memory"]
