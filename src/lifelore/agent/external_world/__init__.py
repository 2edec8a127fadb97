"""`live_in`: an agent lives in a world of the user, through the `World` protocol only.

Read in this order: `live_in`, `episode`, `table_learner`, `useful_actions`, `own_agent`, `context_code`,
`context_labels`, `stored_prior`; then `life_summary`, `life_warnings` and `task_differences`, which judge a life.
"""
