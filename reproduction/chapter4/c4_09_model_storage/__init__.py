"""Claim C4.9."""
