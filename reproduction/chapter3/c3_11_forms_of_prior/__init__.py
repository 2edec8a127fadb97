"""Claim C3.11."""
