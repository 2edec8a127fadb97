"""The engine of claims: registry, runner, cell store, marks, words, pages.

Read in this order: `statement`, `claim`, `registry`, `reproduce`, `run_cells`, `cell_store`, `source_key`,
`verify`, `statement_figures`, `pages`.
"""
