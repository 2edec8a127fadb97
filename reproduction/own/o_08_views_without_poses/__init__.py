"""Claim O8."""
