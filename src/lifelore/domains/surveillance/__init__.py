"""The surveillance reserve with four hills (thesis §4.6.4).

Read in this order: `surveillance` (the world), `environment` (Gymnasium), `picture`.
"""
