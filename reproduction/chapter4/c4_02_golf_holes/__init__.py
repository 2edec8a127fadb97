"""Claim C4.2."""
