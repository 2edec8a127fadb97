"""Search guided by priors: trees, depth-first, bandits; and reduction of a domain (thesis §3.2.3, §3.8).

Read in this order: `tree_search`, `depth_first`, `bandit`, `domain_reduction`.
"""
