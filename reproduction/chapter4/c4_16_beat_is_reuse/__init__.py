"""Claim C4.16."""
