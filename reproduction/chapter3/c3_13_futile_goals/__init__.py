"""Claim C3.13."""
