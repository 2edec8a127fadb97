"""Core: errors, random streams, tasks as arrays, fast kernels and metrics; knows no world, prior or file format.

`mdp` writes a task down, `planning` solves it, `learning` learns it, `compiled` makes kernels fast.
`protocols`, `relations` and `labelled_cloud` are what rooms exchange.
"""
