"""Benchmark of policy reuse, beside loops, MABWiser and BoTorch."""
