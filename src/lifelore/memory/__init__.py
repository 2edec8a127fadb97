"""Memory: stores records of many robots between runs and merges them; the only package that uses SQL.

A memory is a set of *contributions* (the records of one robot about one task) and a set of *tombstones*
(identities of forgotten contributions). Merging two memories unites both sets, so the result does not depend on
order and grouping. The merged cells that `Memory.recall` reads are a cache, which `Memory.rebuild` computes again.

Read in this order: `memory`, `contribution`, `folding`, `ledger`, `cache`, `leases`, `merging`, `export`; then
`store`, `connection`, `sqlite_file`, `schema`, `refusal` for the database.
"""

from lifelore.memory.memory import Memory, open_memory

__all__ = ["Memory", "open_memory"]
