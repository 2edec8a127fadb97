"""Claim C5.1."""
