"""Claim O2."""
