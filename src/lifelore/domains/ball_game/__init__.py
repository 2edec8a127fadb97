"""The ball game with a speed that somebody else controls (thesis §4.8).

Read in this order: `ball_game` (the world), `layouts`, `paths`, `simulated_player`, `environment`,
`picture`.
"""
