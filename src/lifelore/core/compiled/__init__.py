"""Compiled kernels: Numba with a cache on disk, random numbers inside kernels, and CUDA.

Read in this order: `jit`, `kernel_cache`, `numba_internals`, `random_state`, `cuda`.
"""
