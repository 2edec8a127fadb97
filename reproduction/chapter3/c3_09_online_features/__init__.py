"""Claim C3.9."""
