"""Claim C5.2."""
