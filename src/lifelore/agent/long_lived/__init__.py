"""The long-lived agent: one life of many tasks, in which the three abstractions meet.

`type_prior` learns which types to expect in a context from the posteriors of past tasks.
"""
