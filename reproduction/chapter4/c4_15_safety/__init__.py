"""Claim C4.15."""
