"""Bayesian policy reuse (thesis Alg. 7): for one agent and for very many users at once.

Read in this order: `reuse_algorithm`, `bayesian_policy_reuse`, `user_beliefs`; `novelty` tells whether no known
type fits; `reuse_session` stores an agent in a file, `explanation` explains a choice, `regret` and `calibration`
measure it.
"""
