"""Claim C4.6."""
