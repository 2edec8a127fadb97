"""Interface adaptation: choose an action set for the type of the user at every step (BEAT, thesis Alg. 9).

Read in this order: `beat`, `move_signal` (log likelihoods of moves from counts).
"""
