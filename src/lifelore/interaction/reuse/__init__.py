"""Bayesian policy reuse (thesis Alg. 7): for one agent and for very many users at once.

Read in this order: `reuse_algorithm`, `bayesian_policy_reuse`, `user_beliefs`, `user_kernels`,
`hazard_user_kernels`; `reuse_session` and `user_file` store them in files, `explanation` explains a choice,
`regret` and `calibration` measure it.
"""
