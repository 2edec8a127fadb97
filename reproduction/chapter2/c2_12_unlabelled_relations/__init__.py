"""Claim C2.12."""
