"""Claim C2.11."""
