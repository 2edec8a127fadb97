"""Planning: exact solutions of tasks written as tables.

Read in this order: `planning`, `layered_planning`.
"""
