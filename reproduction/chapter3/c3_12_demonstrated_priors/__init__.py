"""Claim C3.12."""
