"""Claim C2.3."""
