"""Claim C4.1."""
