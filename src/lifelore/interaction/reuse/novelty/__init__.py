"""Detection of tasks and users of a type that the library does not have.

Read in this order: `broad_library` (a type as broad as all known types together), `unknown_evidence` (its log odds
against the known types, for the probability), `misfit` (the statistic of the alarm), `known_tasks` and
`calibration` (its threshold, by simulation), `novelty_detector`.
"""
