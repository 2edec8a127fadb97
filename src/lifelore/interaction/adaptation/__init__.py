"""Interface adaptation: choose an action set for the type of the user at every step (BEAT, thesis Alg. 9)."""
