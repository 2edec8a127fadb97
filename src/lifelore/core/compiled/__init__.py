"""Compiled kernels: Numba with a cache on disk, and random numbers inside kernels.

Read in this order: `jit`, `kernel_cache`, `random_state`.
"""
