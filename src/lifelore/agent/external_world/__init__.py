"""`live_in`: an agent lives in a world of the user, through the `World` protocol only.

Read in this order: `live_in`, `task`, `useful_actions`, `context_code`, `stored_prior`.
"""
