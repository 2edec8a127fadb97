"""Claim O1."""
