"""Claim C3.4."""
