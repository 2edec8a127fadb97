"""Claim C3.14."""
