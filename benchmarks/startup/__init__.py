"""Benchmark of the first answer: of a learner, and of each verb from the shell."""
