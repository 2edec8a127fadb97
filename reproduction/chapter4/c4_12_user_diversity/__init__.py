"""Claim C4.12."""
