"""Benchmarks of policy reuse, beside loops, MABWiser and BoTorch, and of a user with a long history."""
