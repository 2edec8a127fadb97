"""Grid worlds with four moves: cells, percepts, goal tasks, and the mazes of chapter 3.

Read in this order: `grid_world`, `lattice`, `noise_maze`, `grid_picture`; then `cell_numbers`.
"""
