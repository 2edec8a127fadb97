"""Features that a prior is conditioned on, and their selection by entropy (thesis §3.3.2, §3.3.3).

Read in this order: `feature_set`, `feature_function`, `counted_features`, `feature_selection`, `uncertainty`,
`feature_acquisition`; `learnt_contexts` stands alone.
"""
