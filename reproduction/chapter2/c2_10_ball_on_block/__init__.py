"""Claim C2.10."""
