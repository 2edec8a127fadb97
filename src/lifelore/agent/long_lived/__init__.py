"""The long-lived agent: one life of many tasks, in which the three abstractions meet.

Read in this order: `live_task` (one task from top to bottom), `task_family` (what a world has to offer),
`recognition` (belief and alarm), `known_types` (the laws by which it plans), `knowledge` (all that is learnt, and
its records), `long_life` (task after task on a memory), `explanation` and `curiosity`. `families` are the worlds,
and `agent.types` the statistics of types.
"""
