"""Priors over actions: counts, forms, features and prior-guided learning (ch. 3)."""
