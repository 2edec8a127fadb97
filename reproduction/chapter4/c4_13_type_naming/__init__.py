"""Claim C4.13."""
