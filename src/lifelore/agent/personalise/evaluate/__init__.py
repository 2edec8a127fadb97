"""The verb `lifelore reuse evaluate`: what other policies would have achieved, from a log with probabilities.

Read in this order: `logged_decisions`, `target_policies`, `target_estimates`, `evaluate`.
"""
