"""Claim C5.7."""
