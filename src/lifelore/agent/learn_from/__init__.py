"""`lifelore learn-from`: what a real robot tried and bumped into teaches transitions and the action prior.

Read in this order: `run_log` (runs from a CSV file), `tried_moves` (poses become moves), `learn_from`.
"""
