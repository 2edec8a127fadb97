"""Claim C3.17."""
