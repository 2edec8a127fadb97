"""Trees: extremely randomised trees as flat arrays, trained on pair features.

Read in this order: `tree_relations` (predict), `tree_training` (fit), `tree_ensemble`.
"""
