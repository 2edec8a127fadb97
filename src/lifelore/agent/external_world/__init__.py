"""`live_in`: the agent lives in a world of the user's own, met only through the `World` protocol.

Read in this order: `live_in`, `task`, `context_code`.
"""
