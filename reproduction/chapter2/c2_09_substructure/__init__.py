"""Claim C2.9."""
