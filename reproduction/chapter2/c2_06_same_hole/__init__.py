"""Claim C2.6."""
