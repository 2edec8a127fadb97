"""`live_in`: an agent lives in a world of the user, through the `World` protocol only.

Read in this order: `live_in`, `task`, `own_agent`, `useful_actions`, `context_code`, `context_labels`,
`stored_prior`; then `life_summary`, `life_warnings` and `task_differences`, which judge a life.
"""
