"""The advice maze and the simulated people who explore it (thesis §3.7).

Read in this order: `advice_maze`, `explorers`.
"""
