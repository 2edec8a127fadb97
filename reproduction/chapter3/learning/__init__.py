"""Schedules of ε, and learners in grid worlds."""
