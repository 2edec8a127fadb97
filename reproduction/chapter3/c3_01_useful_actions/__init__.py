"""Claim C3.1."""
