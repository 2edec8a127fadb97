"""Bayesian policy reuse (thesis Alg. 7): for one agent and for very many users at once.

Read in this order: `reuse_algorithm`, `bayesian_policy_reuse`, `user_beliefs`, `user_kernels`,
`hazard_user_kernels`; `unknown_type` gives the probability that no known type fits; `reuse_session` and
`user_file` store them in files, `explanation` explains a choice, `regret` and `calibration` measure it.
"""
