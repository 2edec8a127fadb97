"""Claim C2.7."""
