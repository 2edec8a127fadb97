"""The long-lived agent: one life of many tasks, in which the three abstractions meet.

Read in this order: `live_task` (one task from top to bottom), `task_family` (what a world has to offer),
`recognition` (belief and alarm), `known_types` (counts of effects and their laws), `same_type` (which types are
one), `knowledge` (all that is learnt, and its records), `type_prior` (which types to expect in a context),
`long_life` (task after task on a memory), `explanation` and `curiosity`. `families` are the worlds.
"""
