"""Claim C3.3."""
