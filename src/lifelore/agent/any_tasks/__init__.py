"""`LongLivedAgent`: a life in tasks of anyone's Gymnasium environments, with types, policies and an action prior.

Read in this order: `long_lived_agent`, `task_settings`, `one_task`, `reuse`, `learners`, `experience`,
`known_moves`, `moves`; then `side_by_side`, which `live_in` and `comparison` call, and `stored_prior`.
"""
