"""Claim C3.8."""
