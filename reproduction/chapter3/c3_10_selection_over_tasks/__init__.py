"""Claim C3.10."""
