"""Golf with an unknown distance to the hole (thesis §4.6.1).

Read in this order: `golf` (the world), `environment` (Gymnasium), `picture`.
"""
