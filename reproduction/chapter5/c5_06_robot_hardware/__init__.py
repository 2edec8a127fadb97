"""Claim C5.6."""
