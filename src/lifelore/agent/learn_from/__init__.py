"""`lifelore learn-from`: what a real robot tried and bumped into teaches moves, times and the action prior.

Read in this order: `run_log` (runs from a CSV file), `log_fit` (does the log fit the map?), `tried_moves` (poses
become moves), `learnt_runs` (moves become records), `learn_from`.
"""
