"""Claim C3.5."""
