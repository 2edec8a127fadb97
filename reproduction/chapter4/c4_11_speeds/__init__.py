"""Claim C4.11."""
