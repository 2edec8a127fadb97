"""Claim O5."""
