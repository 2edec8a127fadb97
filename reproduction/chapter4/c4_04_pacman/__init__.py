"""Claim C4.4."""
