"""The engine of claims: registry, runner, cell store, marks, words, pages.

Read in this order: `statement`, `claim`, `registry`, `reproduce`, `run_cells`, `cell_store`,
`verify`, `statement_figures`, `pages`.
"""
