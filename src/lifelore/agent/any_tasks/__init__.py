"""`LongLivedAgent`: a life in tasks of anyone's Gymnasium environments, with types, policies and an action prior.

Read in this order: `long_lived_agent`, `task_settings`, `one_task`, `reuse`, `learners`, `experience`,
`known_moves`, `moves`; then `live_in`, `comparison` and `stored_prior`.
"""
