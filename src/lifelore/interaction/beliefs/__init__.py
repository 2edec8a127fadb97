"""Beliefs over types in log space, and how types change between episodes.

Read in this order: `belief`, `type_dynamics`, `learnt_dynamics`, `feature_prior`.
"""
