"""Claim O4."""
