"""Claim C4.5."""
