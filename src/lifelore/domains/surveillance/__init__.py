"""The surveillance reserve with four hills (thesis §4.7.1).

Read in this order: `surveillance` (the world), `environment` (Gymnasium), `picture`.
"""
