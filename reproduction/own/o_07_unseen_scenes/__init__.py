"""Claim O7."""
