"""Claim C5.3."""
