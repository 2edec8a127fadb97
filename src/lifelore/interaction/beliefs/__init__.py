"""Beliefs over types in log space, and how types change between episodes.

Read in this order: `belief`, `bayes_rule`, `belief_kernels`, `hazard`, `hazard_kernels`, `type_dynamics`,
`feature_prior`.
"""
