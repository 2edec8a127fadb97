"""Claim C4.17."""
