"""Claim C3.7."""
