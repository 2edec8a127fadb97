"""Claim C3.18."""
