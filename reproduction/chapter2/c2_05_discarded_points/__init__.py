"""Claim C2.5."""
