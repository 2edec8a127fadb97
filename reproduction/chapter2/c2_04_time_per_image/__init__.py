"""Claim C2.4."""
