"""Claim C2.8."""
