"""Claim C3.16."""
