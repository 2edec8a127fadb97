"""Benchmarks of the Q-learning kernel, beside C, a textbook loop and tuned Python."""
