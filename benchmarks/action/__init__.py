"""Benchmarks of priors: contexts, a factory task, and a prior in Stable-Baselines3."""
