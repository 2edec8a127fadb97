"""Bayesian policy reuse (thesis Alg. 7): for one agent and for very many users at once.

Read in this order: `reuse_algorithm`, `bayesian_policy_reuse`, `user_beliefs`; `unknown_law` and `unknown_users`
weigh a type that is not known against the known types, and `novelty` raises alarms; `reuse_session` stores an
agent in a file, `explanation` explains a choice, `regret` and `calibration` measure it.
"""
