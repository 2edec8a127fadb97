"""Claim C2.1."""
