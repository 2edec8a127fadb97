"""Claim C4.10."""
