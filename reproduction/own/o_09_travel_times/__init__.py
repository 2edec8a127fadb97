"""Claim O9."""
