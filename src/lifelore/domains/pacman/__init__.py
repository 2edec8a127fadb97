"""Pacman in a figure-eight maze (thesis §4.6.3).

Read in this order: `pacman` (the world), `environment` (Gymnasium), `picture`.
"""
