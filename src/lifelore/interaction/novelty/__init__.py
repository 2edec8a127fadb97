"""Detection of tasks and users of a type that the library does not have.

Read in this order: `signal_laws` (what a mixture of types predicts), `broad_law` (the law where no known type
fits), `novelty_statistics` (statistics of a task), `known_tasks` and `calibration` (the threshold, by simulation),
`novelty_detector`.
"""
