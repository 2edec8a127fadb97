"""Benchmarks of whole lives: the courier at home and elsewhere, and buildings that grow."""
