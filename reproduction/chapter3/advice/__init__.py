"""Mazes, errands and experts of the claims on advice (C3.15 to C3.18), their learner and their figures."""
