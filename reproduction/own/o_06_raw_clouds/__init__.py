"""Claim O6."""
