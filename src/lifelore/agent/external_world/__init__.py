"""A world of the user: its episodes, states and contexts, and a learner by table in one of its tasks.

Read in this order: `gymnasium_world`, `episode`, `table_learner`, `useful_actions`, `own_agent`, `context_code`,
`context_labels`; then `life_summary` and `life_warnings`, which judge a life.
"""
