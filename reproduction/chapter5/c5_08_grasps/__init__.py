"""Claim C5.8."""
