"""The telephone service with unknown language models of its callers (thesis §4.6.2).

Read in this order: `telephone` (the world), `environment` (Gymnasium), `picture`.
"""
