"""Interface adaptation: choose an action set for the type of the user at every step (BEAT, thesis Alg. 8).

Read in this order: `beat` (one user), `beat_users` (many), `move_model` (likelihoods of moves from counts).
"""
