"""Claim C5.9: `agents` meet `schedules` of types in `thesis_worlds` and `small_games`; see `run`."""
