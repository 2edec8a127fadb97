"""Claim C4.14."""
