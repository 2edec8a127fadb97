"""Claim C4.7."""
