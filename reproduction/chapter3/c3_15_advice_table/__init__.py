"""Claim C3.15."""
