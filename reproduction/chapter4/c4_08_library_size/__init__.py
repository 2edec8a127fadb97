"""Claim C4.8."""
