"""Claim C4.3."""
