"""Core: errors, random streams, tasks as arrays, fast kernels and metrics; knows no world, prior or file format.

`mdp` defines tasks as tables, `planning` solves them, `learning` learns them, `compiled` compiles kernels.
Rooms exchange the types of `protocols`, `relations` and `labelled_cloud`.
"""
