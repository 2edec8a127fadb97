"""Claim C3.2."""
