"""Detection of tasks and users of a type that the library does not have.

Read in this order: `library.signal_laws` (what a mixture of types predicts), `library.broad_law` (the law where no
known type fits), `novelty_statistics` (statistics of a task), `known_tasks` and `calibration` (the threshold, by
simulation), `novelty_detector`. An agent computes the probability alone with `reuse.unknown_type`.
"""
