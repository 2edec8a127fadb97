"""Claim C3.6."""
