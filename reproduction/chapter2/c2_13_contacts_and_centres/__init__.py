"""Claim C2.13."""
