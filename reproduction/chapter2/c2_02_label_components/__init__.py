"""Claim C2.2."""
