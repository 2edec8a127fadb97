"""The engine of claims: registry, runner, cell store, predicate, verdict, report.

Read in this order: `claim`, `ledger`, `registry`, `reproduce`, `cell_store`, `source_key`, `predicate`, `report`.
"""
