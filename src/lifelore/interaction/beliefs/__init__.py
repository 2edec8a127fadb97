"""Beliefs over types in log space, and how types change between episodes.

Read in this order: `belief`, `belief_kernels`, `type_dynamics`.
"""
