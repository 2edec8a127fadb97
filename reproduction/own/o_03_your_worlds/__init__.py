"""Claim O3."""
