"""Bayesian policy reuse (thesis Alg. 7): for one agent and for very many users at once.

Read in this order: `bayesian_policy_reuse`, `user_beliefs`, `user_likelihood`, `user_kernels`; `reuse_session` and
`user_file` store a session, `evidence` explains a choice, `regret` measures it.
"""
