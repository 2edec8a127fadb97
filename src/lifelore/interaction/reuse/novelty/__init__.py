"""Detection of tasks and users of a type that the library does not have.

Read in this order: `unknown_evidence` (rows with the log odds of `unknown_users`, for the probability), `misfit`
(the statistic of the alarm), `known_tasks` and `calibration` (its threshold, by simulation), `novelty_detector`.
"""
